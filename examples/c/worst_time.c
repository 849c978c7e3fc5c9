/* How long a drive may take to be found: random questions, each timed, the slowest ones asked again.
 *
 *     worst_time QUERIES plane|reversals [bounded]
 *     worst_time QUERIES ROVER.toml      [bounded]     on hilly ground with rocks
 *
 * Times are those of the thread's own processor time. A query's time is what it took at once; of the twenty slowest the
 * least of twenty more looks is told as well, which leaves out what the machine did besides.
 */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "hairpin.h"

#define CELLS 200
#define SLOWEST 20
#define LOOKS 20

static uint64_t stream = 1;

/* A uniform number from low to high: SplitMix64. */
static double between(double low, double high)
{
    uint64_t z = (stream += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return low + (high - low) * (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

static double now_us(void)
{
    struct timespec at;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &at);
    return 1e6 * (double)at.tv_sec + 1e-3 * (double)at.tv_nsec;
}

static void must(hairpin_code code, const hairpin_error *error)
{
    if (code != HAIRPIN_OK) {
        fprintf(stderr, "code %d: %s\n", (int)code, error->message);
        exit(2);
    }
}

static int rising(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static hairpin_rover *rover_of(const char *path)
{
    static char text[65536];
    hairpin_error error;
    hairpin_rover *rover = NULL;
    FILE *file = fopen(path, "rb");
    size_t length = file ? fread(text, 1, sizeof text, file) : 0;
    if (file) {
        fclose(file);
    }
    must(hairpin_rover_from_toml(text, length, &rover, &error), &error);
    return rover;
}

static hairpin_map *hills(void)
{
    static float heights[CELLS * CELLS];
    hairpin_grid grid = {CELLS, CELLS, {0.0, 0.0}, {0.2, 0.2}};
    hairpin_error error;
    hairpin_map *map = NULL;
    size_t row, column;
    for (row = 0; row < CELLS; row++) {
        for (column = 0; column < CELLS; column++) {
            const double x = 0.2 * (double)column, y = 0.2 * (double)row;
            const double rock = between(0.0, 1.0) < 0.01 ? between(0.05, 0.15) : 0.0;
            heights[row * CELLS + column] = (float)(0.5 * sin(0.4 * x) * cos(0.3 * y) + 0.08 * sin(1.7 * x + y) + rock);
        }
    }
    must(hairpin_map_new(&grid, heights, HAIRPIN_HOLES_REFUSED, &map, &error), &error);
    return map;
}

/* Anywhere around the start, looking and bending anyhow. */
static void ask(int on_ground, double most, hairpin_state *start, hairpin_state *goal)
{
    const double far = on_ground ? 5.0 : 6.0, from = on_ground ? 8.0 : 0.0, to = on_ground ? 31.0 : 0.0;
    start->x_m = between(from, to), start->y_m = between(from, to), start->yaw_rad = between(-3.1415926, 3.1415926);
    goal->x_m = start->x_m + between(-far, far), goal->y_m = start->y_m + between(-far, far);
    goal->yaw_rad = between(-3.1415926, 3.1415926);
    start->curvature_1_m = on_ground ? 0.0 : between(-most, most);
    goal->curvature_1_m = on_ground ? 0.0 : between(-most, most);
}

static double timed(const hairpin_steerer *steer, const hairpin_state *start, const hairpin_state *goal,
                    hairpin_drive *drive)
{
    hairpin_error error;
    const double begun = now_us();
    const hairpin_code code = hairpin_steer(steer, start, goal, drive, &error);
    const double took = now_us() - begun;
    must(code, &error);
    return took;
}

int main(int count, char **words)
{
    const long asked = count > 2 ? atol(words[1]) : 0;
    const size_t queries = asked > 0 ? (size_t)asked : 0;
    const int bounded = count > 3 && strcmp(words[3], "bounded") == 0;
    const int reversals = count > 2 && strcmp(words[2], "reversals") == 0;
    const int on_ground = count > 2 && !reversals && strcmp(words[2], "plane") != 0;
    hairpin_steer_settings settings = bounded ? hairpin_steer_fixed_budget() : hairpin_steer_defaults();
    hairpin_state slow_start[SLOWEST], slow_goal[SLOWEST], start, goal;
    double slow[SLOWEST] = {0.0}, *times = malloc((queries + 1) * sizeof *times), again = 0.0;
    hairpin_rover *rover = NULL;
    hairpin_map *map = NULL;
    hairpin_steerer *steer = NULL;
    hairpin_limits limits;
    hairpin_drive drive;
    hairpin_error error;
    size_t i, j, solved = 0, spent = 0;
    unsigned most_iterations = 0;
    unsigned long long most_looks = 0;

    if (queries == 0 || times == NULL) {
        fprintf(stderr, "worst_time QUERIES plane|reversals|ROVER.toml [bounded]\n");
        free(times);
        return 2;
    }
    if (on_ground) {
        rover = rover_of(words[2]);
        map = hills();
    } else {
        must(hairpin_rover_new(1.0, 1.0, &rover, &error), &error);
    }
    must(hairpin_rover_limits(rover, &limits, &error), &error);
    settings.reversals = reversals;
    must(hairpin_steer_new(rover, map, &settings, &steer, &error), &error);
    stream = count > 4 ? (uint64_t)strtoull(words[4], NULL, 10) : 7;
    for (i = 0; i < queries; i++) {
        size_t least = 0;
        ask(on_ground, limits.curvature_1_m, &start, &goal);
        times[i] = timed(steer, &start, &goal, &drive);
        solved += drive.status == HAIRPIN_SOLVED;
        spent += drive.status == HAIRPIN_BUDGET_SPENT;
        most_iterations = drive.iterations > most_iterations ? drive.iterations : most_iterations;
        most_looks = drive.looks > most_looks ? drive.looks : most_looks;
        for (j = 1; j < SLOWEST; j++) {
            least = slow[j] < slow[least] ? j : least;
        }
        if (times[i] > slow[least]) {
            slow[least] = times[i], slow_start[least] = start, slow_goal[least] = goal;
        }
    }
    for (j = 0; j < SLOWEST && j < queries; j++) {
        double quickest = slow[j];
        for (i = 0; i < LOOKS; i++) {
            const double took = timed(steer, &slow_start[j], &slow_goal[j], &drive);
            quickest = took < quickest ? took : quickest;
        }
        again = quickest > again ? quickest : again;
    }
    qsort(times, queries, sizeof *times, rising);
    printf("%s%s: %lu queries, %lu solved, %lu spent their budget, at most %u iterations, %llu looks\n", words[2],
           bounded ? ", bounded" : "", (unsigned long)queries, (unsigned long)solved, (unsigned long)spent,
           most_iterations, most_looks);
    printf("median %.1f us, 99 %% %.1f us, 99.99 %% %.1f us, worst %.1f us; the slowest, asked again: %.1f us\n",
           times[queries / 2], times[(size_t)(0.99 * (double)(queries - 1))],
           times[(size_t)(0.9999 * (double)(queries - 1))], times[queries - 1], again);
    free(times);
    hairpin_steer_free(steer);
    hairpin_map_free(map);
    hairpin_rover_free(rover);
    return 0;
}
