/* The rover trajectory generator's own example (T. Howard's user guide, 2006), then the same drive on hilly ground.
 *
 *     TrajectoryGenerator TrajGen(RobotModel);                          hairpin_rover_new, hairpin_steer_new
 *     if (TrajGen.SolveTrajectory(initialState, terminalState)) {       hairpin_steer
 *         VehicleControls controls = TrajGen.GetVehicleControls();      drive.segments
 *         Path path = TrajGen.GetPath();                                hairpin_follow
 *     }
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "hairpin.h"

#define CELLS 60
#define MOMENTS 64

/* The robot's file is text of ours: no file is read. */
static const char FOUR_WHEELS[] = "kind = \"rover\"\nname = \"own\"\n[limits]\ncurvature_1_m = 1.0\ntilt_deg = 30\n"
                                  "[suspension]\nkind = \"four-wheel\"\nwheel_radius_m = 0.12\n"
                                  "front_m = [0.3, 0.25, 0.0]\nrear_m = [-0.3, 0.25, 0.0]\n";

static void must(hairpin_code code, const hairpin_error *error)
{
    if (code != HAIRPIN_OK) {
        fprintf(stderr, "code %d: %s\n", (int)code, error->message);
        exit(2);
    }
}

static void tell(const char *where, const hairpin_drive *drive)
{
    uint32_t i;
    printf("%s: status %d, %.3f m, ends %.1e m from the goal\n", where, (int)drive->status, drive->length_m,
           drive->miss_m);
    for (i = 0; i < drive->count; i++) {
        const hairpin_segment *s = &drive->segments[i];
        printf("  %+d %.3f m, curvature %.3f %+.3f s %+.3f s^2 %+.3f s^3 %+.3f s^4 %+.3f s^5\n", (int)s->direction,
               s->length_m, s->curvature[0], s->curvature[1], s->curvature[2], s->curvature[3], s->curvature[4],
               s->curvature[5]);
    }
}

int main(void)
{
    static float heights[CELLS * CELLS];
    static hairpin_moment path[MOMENTS];
    hairpin_error error;
    hairpin_rover *point = NULL, *wheels = NULL;
    hairpin_map *map = NULL;
    hairpin_steerer *plane = NULL, *ground = NULL;
    hairpin_steer_settings settings = hairpin_steer_fixed_budget();
    hairpin_grid grid = {CELLS, CELLS, {0.0, 0.0}, {0.2, 0.2}};
    hairpin_state start = {0.0, 0.0, 0.0, 0.0}, goal = {1.0, 1.0, 0.785, 0.0};
    hairpin_keep_out rock = {{3.0, 0.0}, 0.5, NULL, 0};
    hairpin_drive drive;
    size_t count = 0, row, column;
    int solved;

    /* In the plane: one metre ahead, one to the left, turned left by 45 degrees. */
    must(hairpin_rover_new(1.0, 1.0, &point, &error), &error);
    settings.reversals = 1;
    must(hairpin_steer_new(point, NULL, &settings, &plane, &error), &error);
    must(hairpin_steer(plane, &start, &goal, &drive, &error), &error);
    tell("in the plane", &drive);
    solved = drive.status == HAIRPIN_SOLVED;
    must(hairpin_follow(plane, &start, &drive, 0.1, path, MOMENTS, &count, &error), &error);
    printf("  %lu moments, the last at %.2f s in (%.3f, %.3f)\n", (unsigned long)count, path[count - 1].t_s,
           path[count - 1].state.x_m, path[count - 1].state.y_m);

    /* Around a rock, which takes memory; crabs and other controls are settings. */
    start.curvature_1_m = goal.curvature_1_m = goal.y_m = goal.yaw_rad = 0.0, goal.x_m = 6.0;
    must(hairpin_steer_clear(plane, &start, &goal, &rock, 1, &drive, &error), &error);
    tell("around a rock", &drive);
    solved = solved && drive.status == HAIRPIN_SOLVED;

    /* On hills of 20 cm, from the middle of the map to 3 m ahead of it. */
    for (row = 0; row < CELLS; row++) {
        for (column = 0; column < CELLS; column++) {
            heights[row * CELLS + column] = (float)(0.1 * sin(0.3 * (double)column) * cos(0.25 * (double)row));
        }
    }
    must(hairpin_rover_from_toml(FOUR_WHEELS, sizeof FOUR_WHEELS - 1, &wheels, &error), &error);
    must(hairpin_map_new(&grid, heights, HAIRPIN_HOLES_REFUSED, &map, &error), &error);
    must(hairpin_steer_new(wheels, map, NULL, &ground, &error), &error);
    start.x_m = start.y_m = 5.0;
    goal.x_m = 8.0, goal.y_m = 6.0, goal.yaw_rad = 0.785;
    must(hairpin_steer(ground, &start, &goal, &drive, &error), &error);
    tell("on the ground", &drive);
    must(hairpin_confirm(ground, &start, &goal, &drive, &error), &error);
    printf("  replayed: status %d, %.1e m from the goal, leaning %.1f deg at most\n", (int)drive.status, drive.miss_m,
           drive.tilt_rad * 57.29577951308232);
    solved = solved && drive.status == HAIRPIN_SOLVED;

    /* What is no question is refused with a sentence. */
    goal.x_m = NAN;
    if (hairpin_steer(ground, &start, &goal, &drive, &error) != HAIRPIN_OK) {
        printf("refused: %s\n", error.message);
    }

    hairpin_steer_free(ground);
    hairpin_steer_free(plane);
    hairpin_map_free(map);
    hairpin_rover_free(wheels);
    hairpin_rover_free(point);
    return solved ? 0 : 1;
}
