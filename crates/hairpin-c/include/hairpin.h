/*
 * hairpin in C: drives of ground vehicles between two states, the heaviest paths through tables of costs, and tracks
 * held to limits. The guide is docs/c.md; hairpin.hpp is the same for C++.
 *
 * Pointers. Whatever is not said to be NULL at times must lead to what its type says, as many of it as the size beside it
 * has, and stay so until the call ends; what is written to is the call's alone meanwhile. NULL, misplaced pointers, sizes
 * that memory cannot have and numbers out of bounds are refused by a code; that a pointer leads where it should cannot
 * be checked.
 *
 * Threads. Handles are never changed: any number of threads may use one at once, each with a hairpin_error of its own.
 *
 * Made by cbindgen of crates/hairpin-c/src; changes belong there.
 */

#ifndef HAIRPIN_H
#define HAIRPIN_H

#include <stddef.h>
#include <stdint.h>

/**
 * Bytes of a message, the closing NUL included; longer ones are cut.
 */
#define HAIRPIN_MESSAGE 256

/**
 * A map with cells without data is refused.
 */
#define HAIRPIN_HOLES_REFUSED 0

/**
 * Nothing may touch cells without data.
 */
#define HAIRPIN_HOLES_KEEP_OUT 1

/**
 * Heights are interpolated over cells without data.
 */
#define HAIRPIN_HOLES_FILL 2

/**
 * Of fifth order in the way: the usual one, with chains of clothoids where it keeps no bound.
 */
#define HAIRPIN_CONTROL_QUINTIC 0

/**
 * Constant: heading and curvature at the goal are as they come.
 */
#define HAIRPIN_CONTROL_ARC 1

/**
 * Of third order in the way.
 */
#define HAIRPIN_CONTROL_CUBIC 2

/**
 * A turn in place, a straight, a turn in place.
 */
#define HAIRPIN_CONTROL_TURN_DRIVE_TURN 3

/**
 * Of fifth order in time.
 */
#define HAIRPIN_CONTROL_TIME_POLYNOMIAL 4

/**
 * The natural cubic spline through eight even knots of the way.
 */
#define HAIRPIN_CONTROL_KNOTS 5

/**
 * Turn rate over speed, both polynomials of time.
 */
#define HAIRPIN_CONTROL_VELOCITY_POLYNOMIAL 6

/**
 * Steps for one goal of the fixed budget.
 */
#define HAIRPIN_FIXED_STEPS 60

/**
 * Looks at a map of the fixed budget.
 */
#define HAIRPIN_FIXED_LOOKS 100000

/**
 * Segments of a drive at most.
 */
#define HAIRPIN_MOST_SEGMENTS 40

/**
 * The drive meets its goal and keeps all bounds.
 */
#define HAIRPIN_SOLVED 0

/**
 * What was found breaks `limit` by `excess`.
 */
#define HAIRPIN_INFEASIBLE 1

/**
 * The goal was not met.
 */
#define HAIRPIN_NOT_CONVERGED 2

/**
 * The ground lets it go no further than `stopped_after_m`: `limit` says why.
 */
#define HAIRPIN_BLOCKED 3

/**
 * The budget was spent first; the drive is the best so far, if there is one.
 */
#define HAIRPIN_BUDGET_SPENT 4

/**
 * A single arc, or a chain of clothoids, in one gear.
 */
#define HAIRPIN_BY_ARC 0

/**
 * Turn, drive, turn.
 */
#define HAIRPIN_BY_TURNS 1

/**
 * Lines, arcs and clothoids in closed form.
 */
#define HAIRPIN_BY_CLOTHOIDS 2

/**
 * Bytes of a limit's name, the closing NUL included.
 */
#define HAIRPIN_NAME 32

/**
 * Moments of a drive that is followed, at most.
 */
#define HAIRPIN_MOST_MOMENTS 1000000

/**
 * A cost that says that there is no arc.
 */
#define HAIRPIN_NO_ARC -1

/**
 * An end that may be any point.
 */
#define HAIRPIN_ANY_POINT -1

/**
 * There is a path.
 */
#define HAIRPIN_FOUND 0

/**
 * The fixed end cannot be reached from the fixed start: proven.
 */
#define HAIRPIN_NO_PATH 1

/**
 * No path costs as much as is wanted: proven.
 */
#define HAIRPIN_BELOW_MIN_COST 2

/**
 * None was found yet.
 */
#define HAIRPIN_NOT_FOUND 3

/**
 * No sample counts in the deviation: all are within `corner_m` of a waypoint.
 */
#define HAIRPIN_UNMEASURED_DEVIATION 1

/**
 * There are too few samples for an acceleration.
 */
#define HAIRPIN_UNMEASURED_ACCELERATION 2

/**
 * A waypoint that was to be reached at a time was not reached.
 */
#define HAIRPIN_UNMEASURED_LATE 4

/**
 * A waypoint was not reached, by `reached_s`, of a track that came to its end.
 */
#define HAIRPIN_UNMEASURED_WAYPOINTS 8

/**
 * Samples have attitudes.
 */
#define HAIRPIN_TOLD_ATTITUDE 1

/**
 * Samples have velocities.
 */
#define HAIRPIN_TOLD_VELOCITY 2

/**
 * Samples have legs.
 */
#define HAIRPIN_TOLD_LEG 4

/**
 * Deviation from the segment of the leg that is flown.
 */
#define HAIRPIN_FROM_LEG 0

/**
 * Deviation from the nearer of that segment and the one before.
 */
#define HAIRPIN_FROM_NEAREST_LEG 1

/**
 * Deviation from the polyline `path_m`.
 */
#define HAIRPIN_FROM_PATH 2

/**
 * The track ends where the mission did.
 */
#define HAIRPIN_ENDED_DONE 0

/**
 * The track ends because its time was over.
 */
#define HAIRPIN_ENDED_TIME 1

/**
 * The track ends in a crash.
 */
#define HAIRPIN_ENDED_CRASH 2

/**
 * An elevation map. Nothing changes it, so that any number of threads may use it.
 */
typedef struct hairpin_map hairpin_map;

/**
 * A vehicle. Nothing changes it, so that any number of threads may use it.
 */
typedef struct hairpin_rover hairpin_rover;

/**
 * A vehicle, what it drives on, and how its drives are looked for. Nothing changes it, so that any number of threads
 * may ask it at once.
 */
typedef struct hairpin_steerer hairpin_steerer;

/**
 * What a call answers: HAIRPIN_OK, or why it did nothing.
 */
typedef int32_t hairpin_code;

/**
 * Why a call did nothing. Lies in the caller's memory, so that every thread has its own; written by every call that is
 * given one, also where it succeeds.
 */
typedef struct {
  /**
   * What the call answered.
   */
  hairpin_code code;
  /**
   * A sentence in UTF-8 that ends with NUL; empty where it succeeded.
   */
  char message[HAIRPIN_MESSAGE];
} hairpin_error;

/**
 * What a vehicle may do.
 */
typedef struct {
  /**
   * Largest curvature, 1/m.
   */
  double curvature_1_m;
  /**
   * Largest change of curvature, 1/m^2.
   */
  double curvature_rate_1_m2;
  /**
   * Largest speed, m/s; infinite where there is none.
   */
  double speed_m_s;
  /**
   * Speed where none is given, m/s.
   */
  double default_speed_m_s;
  /**
   * Largest angle of the body from the vertical, rad; infinite where there is none.
   */
  double tilt_rad;
  /**
   * 1 where it turns in place.
   */
  int32_t turns_in_place;
} hairpin_limits;

/**
 * Where the cells of a map lie: x east, y north, m.
 */
typedef struct {
  /**
   * Cells along x.
   */
  size_t columns;
  /**
   * Cells along y.
   */
  size_t rows;
  /**
   * Centre of the cell with least x and y.
   */
  double first_center_m[2];
  /**
   * Edges of a cell along x and y.
   */
  double cell_m[2];
} hairpin_grid;

/**
 * How drives are looked for. hairpin_steer_defaults and hairpin_steer_fixed_budget fill it in.
 */
typedef struct {
  /**
   * Distance from the goal that counts as there, m, > 0.
   */
  double tolerance_m;
  /**
   * The same of the heading, rad, > 0.
   */
  double tolerance_yaw_rad;
  /**
   * The same of the curvature, 1/m, > 0.
   */
  double tolerance_curvature_1_m;
  /**
   * Speed along the drive, m/s; 0: the vehicle's own. It matters where commands act late.
   */
  double speed_m_s;
  /**
   * Not 0: the gear may change on the way.
   */
  int32_t reversals;
  /**
   * Not 0: the vehicle may turn in place.
   */
  int32_t turns;
  /**
   * Steps of each descent in the plane at most.
   */
  uint32_t iterations;
  /**
   * Steps of all descents for one goal in the plane at most; 0: no bound.
   */
  uint32_t most_steps;
  /**
   * Predictions for goals in the plane that are learned on a map, at most.
   */
  uint32_t predictions;
  /**
   * Looks at a map at most, of which a settled pose takes some dozen; 0: no bound.
   */
  uint64_t most_looks;
  /**
   * What curvature is a function of, one of HAIRPIN_CONTROL_...; the budgets are the usual one's.
   */
  int32_t control;
  /**
   * Direction of travel in the body where the drive begins, rad, left positive: not 0, it crabs.
   */
  double direction_rad;
  /**
   * By how much that changes until the drive ends, rad, left positive.
   */
  double swing_rad;
} hairpin_steer_settings;

/**
 * Where a vehicle is and how it bends: x forward or east, y left or north, yaw counter-clockwise from x.
 */
typedef struct {
  /**
   * x, m.
   */
  double x_m;
  /**
   * y, m.
   */
  double y_m;
  /**
   * Heading, rad; equal modulo a turn.
   */
  double yaw_rad;
  /**
   * Curvature of the path, 1/m, left positive.
   */
  double curvature_1_m;
} hairpin_state;

/**
 * One piece of a drive: an arc whose curvature is a polynomial of the metres driven on it, or a turn in place.
 */
typedef struct {
  /**
   * 1 forward, -1 in reverse, 0 a turn in place.
   */
  int32_t direction;
  /**
   * Metres; 0 of a turn in place.
   */
  double length_m;
  /**
   * Change of heading in place, rad, left positive; 0 of an arc.
   */
  double angle_rad;
  /**
   * a0 ... a5: curvature a0 + a1 s + ... + a5 s^5 after s metres, 1/m^(i + 1).
   */
  double curvature[6];
} hairpin_segment;

/**
 * What a question is answered with. A start that lies within the tolerances of its goal is answered with no segment.
 */
typedef struct {
  /**
   * HAIRPIN_SOLVED, or what it lacks.
   */
  int32_t status;
  /**
   * One of HAIRPIN_BY_...
   */
  int32_t method;
  /**
   * Segments.
   */
  uint32_t count;
  /**
   * Steps in the plane, predictions on a map.
   */
  uint32_t iterations;
  /**
   * Looks at the map, where they are counted.
   */
  uint64_t looks;
  /**
   * Metres driven.
   */
  double length_m;
  /**
   * By how much the drive misses the goal's place, m: replayed by other equations in the plane, as predicted on a
   * map.
   */
  double miss_m;
  /**
   * The same of the heading, rad.
   */
  double miss_yaw_rad;
  /**
   * The same of the curvature, 1/m.
   */
  double miss_curvature_1_m;
  /**
   * Largest angle of the body from the vertical on a map, rad.
   */
  double tilt_rad;
  /**
   * Metres after which a blocked drive stops.
   */
  double stopped_after_m;
  /**
   * What is broken, as `curvature_1_m`, `position_m`, `tilt_rad`, `map_edge`; empty where nothing is.
   */
  char limit[HAIRPIN_NAME];
  /**
   * By how much, in the unit of its name; NaN where that is no number.
   */
  double excess;
  /**
   * The drive, the first `count` of them.
   */
  hairpin_segment segments[HAIRPIN_MOST_SEGMENTS];
} hairpin_drive;

/**
 * A place to keep out of: a disc, or a polygon where it has corners.
 */
typedef struct {
  /**
   * Middle of the disc, x and y, m.
   */
  double center_m[2];
  /**
   * Its radius, m.
   */
  double radius_m;
  /**
   * Corners of a polygon in turn, x and y each, m; NULL: a disc.
   */
  const double *corners_m;
  /**
   * How many, 3 or more; 0 of a disc.
   */
  size_t corners;
} hairpin_keep_out;

/**
 * One moment of a drive.
 */
typedef struct {
  /**
   * Since the drive began, s.
   */
  double t_s;
  /**
   * Metres driven.
   */
  double s_m;
  /**
   * Over the ground.
   */
  hairpin_state state;
  /**
   * Height of the body, m.
   */
  double z_m;
  /**
   * Roll, rad, to the right positive.
   */
  double roll_rad;
  /**
   * Pitch, rad, nose down positive.
   */
  double pitch_rad;
  /**
   * Speed along the path, m/s; negative in reverse, 0 in turns in place.
   */
  double speed_m_s;
} hairpin_moment;

/**
 * Asked now and then, from any thread, whether to stop: anything but 0 says so. It must not throw and may be asked by
 * several threads at once.
 */
typedef int32_t (*hairpin_stop)(void *context);

/**
 * What is wanted of a path. hairpin_max_load_defaults fills it in.
 */
typedef struct {
  /**
   * First point; HAIRPIN_ANY_POINT: any.
   */
  int64_t start;
  /**
   * Last point; HAIRPIN_ANY_POINT: any.
   */
  int64_t end;
  /**
   * Paths that cost less are not wanted.
   */
  int64_t min_cost;
  /**
   * How many different paths, the heaviest first.
   */
  size_t paths;
  /**
   * How often a point may come, 1 to 16; with more than 1 no arc is used twice.
   */
  size_t visits;
  /**
   * Seed of the local search.
   */
  uint64_t seed;
  /**
   * Problems that each part of branch and bound looks at, at most: the same on every machine; 0: no bound.
   */
  uint64_t most_nodes;
  /**
   * Seconds after which the best so far is the answer; 0: no bound.
   */
  double time_limit_s;
  /**
   * Threads; 0: one for each core. The answer is the same with any number.
   */
  size_t threads;
  /**
   * Says when to stop, or NULL.
   */
  hairpin_stop stop;
  /**
   * What `stop` is called with.
   */
  void *stop_context;
} hairpin_max_load_settings;

/**
 * One path: `count` points from place `first` of the order on.
 */
typedef struct {
  /**
   * Its cost.
   */
  int64_t cost;
  /**
   * Where it begins.
   */
  size_t first;
  /**
   * Points.
   */
  size_t count;
} hairpin_load_path;

/**
 * What came of it.
 */
typedef struct {
  /**
   * HAIRPIN_FOUND, or why there is no path.
   */
  int32_t status;
  /**
   * 1 where the first path is proven the heaviest (all the heaviest ones, where more are wanted).
   */
  int32_t proven;
  /**
   * No path costs more; HAIRPIN_NO_ARC where there is none.
   */
  int64_t bound;
  /**
   * Paths.
   */
  size_t paths;
  /**
   * Points of all paths together.
   */
  size_t points;
  /**
   * Problems that branch and bound looked at.
   */
  uint64_t nodes;
} hairpin_max_load_answer;

/**
 * Signed distance of a place (x, y, z, m) to the nearest obstacle, m, the robot's radius subtracted: infinite where
 * there is none, never NaN. It must not throw and may be asked by several threads at once.
 */
typedef double (*hairpin_clearance)(void *context, const double *position_m);

/**
 * How a track is judged. hairpin_judge_defaults fills it in: nothing has a limit.
 */
typedef struct {
  /**
   * What samples have beside time and place: a sum of HAIRPIN_TOLD_...
   */
  uint32_t told;
  /**
   * One of HAIRPIN_FROM_...
   */
  int32_t reference;
  /**
   * Points of a programmed path, x, y, z each, m; read with HAIRPIN_FROM_PATH.
   */
  const double *path_m;
  /**
   * How many.
   */
  size_t path_points;
  /**
   * Samples as near to a waypoint of their leg, m, do not count in the deviation.
   */
  double corner_m;
  /**
   * One of HAIRPIN_ENDED_...
   */
  int32_t ended;
  /**
   * When each waypoint was reached, s, NaN: never; NULL: all were.
   */
  const double *reached_s;
  /**
   * Distance to obstacles, or NULL.
   */
  hairpin_clearance clearance;
  /**
   * What `clearance` is called with.
   */
  void *clearance_context;
  /**
   * Largest deviation, m; NaN here and below: no limit.
   */
  double max_deviation_m;
  /**
   * Largest overshoot at a waypoint, m.
   */
  double max_overshoot_m;
  /**
   * Largest acceleration, m/s^2.
   */
  double max_acceleration_m_s2;
  /**
   * Least distance to obstacles, m; stands with `clearance`.
   */
  double min_clearance_m;
  /**
   * Longest duration, s.
   */
  double max_total_time_s;
  /**
   * When each waypoint was to be reached, s, as a program of an arm has it; NaN: at no time; NULL: none has one.
   * Read with `reached_s`, of which it is taken off.
   */
  const double *planned_s;
  /**
   * Latest arrival at a waypoint after its planned time, s.
   */
  double max_late_s;
} hairpin_judge_settings;

/**
 * One moment of a track, in one right-handed frame with z up.
 */
typedef struct {
  /**
   * Time, s; rises from sample to sample, by half a nanosecond at least.
   */
  double t_s;
  /**
   * Place, m.
   */
  double position_m[3];
  /**
   * world_from_body as w, x, y, z, of length 1; read with HAIRPIN_TOLD_ATTITUDE.
   */
  double attitude_wxyz[4];
  /**
   * Velocity in the world, m/s; read with HAIRPIN_TOLD_VELOCITY.
   */
  double velocity_m_s[3];
  /**
   * The leg that is flown, from 0, by its first waypoint; read with HAIRPIN_TOLD_LEG.
   */
  int32_t leg;
} hairpin_sample;

/**
 * What is measured of a whole track. NaN: not measured.
 */
typedef struct {
  /**
   * Largest deviation from what was planned, m.
   */
  double max_deviation_m;
  /**
   * When, s.
   */
  double t_worst_s;
  /**
   * On which leg, by its first waypoint.
   */
  size_t leg_worst;
  /**
   * Mean deviation over time, m.
   */
  double mean_deviation_m;
  /**
   * Largest overshoot at a waypoint, m.
   */
  double max_overshoot_m;
  /**
   * Largest acceleration, m/s^2.
   */
  double max_acceleration_m_s2;
  /**
   * When, s.
   */
  double t_acceleration_s;
  /**
   * Least distance to an obstacle, m; infinite where there is none.
   */
  double min_clearance_m;
  /**
   * When, s.
   */
  double t_clearance_s;
  /**
   * Largest angle of the body's upward axis from the world's, degrees.
   */
  double max_tilt_deg;
  /**
   * Duration, s.
   */
  double total_time_s;
  /**
   * Latest arrival at a waypoint, by its planned time, s; negative: all were early.
   */
  double latest_s;
  /**
   * When, s.
   */
  double t_latest_s;
  /**
   * Which leg led there.
   */
  size_t leg_latest;
  /**
   * 1 where legs were not told, and samples were assigned to them along the path.
   */
  int32_t legs_assigned;
  /**
   * Limits that were asked for and could not be measured, a sum of HAIRPIN_UNMEASURED_...; not 0: a track that
   * violates nothing is open, not within its limits.
   */
  uint32_t unmeasured;
} hairpin_measures;

/**
 * What is measured of one leg. NaN: not measured.
 */
typedef struct {
  /**
   * Largest deviation, m.
   */
  double max_deviation_m;
  /**
   * Mean deviation over time, m.
   */
  double mean_deviation_m;
  /**
   * Overshoot at the leg's last waypoint, m.
   */
  double overshoot_m;
  /**
   * Largest acceleration, m/s^2.
   */
  double max_acceleration_m_s2;
  /**
   * Least distance to an obstacle, m.
   */
  double min_clearance_m;
  /**
   * Time spent on it, s.
   */
  double time_s;
  /**
   * How late its last waypoint was reached, by its planned time, s; negative is early.
   */
  double lateness_s;
} hairpin_leg;

/**
 * One limit that is violated.
 */
typedef struct {
  /**
   * What: `deviation`, `overshoot`, `acceleration`, `total-time`, `late`, `clearance`; or `crash`, `unfinished`,
   * `stalled`.
   */
  char what[HAIRPIN_NAME];
  /**
   * What was measured, in the limit's unit; of `crash` when, s; of a track without its end how many waypoints.
   */
  double value;
  /**
   * The limit; of `crash` 0; of a track without its end the number of waypoints.
   */
  double limit;
  /**
   * When, s.
   */
  double t_s;
  /**
   * On which leg, by its first waypoint.
   */
  size_t leg;
} hairpin_violation;

/**
 * Done.
 */
#define HAIRPIN_OK 0

/**
 * A pointer is NULL where something must be.
 */
#define HAIRPIN_NULL 1

/**
 * A number, a size or a text is not what it must be.
 */
#define HAIRPIN_INVALID 2

/**
 * The caller's memory is too small for the result; the answer says how much it takes.
 */
#define HAIRPIN_TOO_SMALL 3

/**
 * The machine lacks what it takes: a thread.
 */
#define HAIRPIN_SYSTEM 4

/**
 * A mistake of hairpin's own, which the message tells.
 */
#define HAIRPIN_INTERNAL 5

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * hairpin's version, as 0.1.0; never to be freed.
 */
const char *hairpin_version(void);

/**
 * Makes a point in the plane that follows its curvature at once, as the generator's source has its generic vehicle.
 *
 * @param max_curvature_1_m largest curvature, 1e-4 to 1e3 1/m
 * @param max_curvature_rate_1_m2 largest change of curvature, 1e-4 to 1e6 1/m^2
 * @param rover the vehicle, to be given back to hairpin_rover_free
 * @param error NULL, or where the call says why it did nothing
 */
hairpin_code hairpin_rover_new(double max_curvature_1_m,
                               double max_curvature_rate_1_m2,
                               hairpin_rover **rover,
                               hairpin_error *error);

/**
 * Makes the vehicle of a robot file: a rover, a car or a differential drive, as data/robots has them.
 *
 * @param text the file's text in UTF-8; it need not end with NUL
 * @param length its bytes
 * @param rover the vehicle, to be given back to hairpin_rover_free
 * @param error NULL, or where the call says why it did nothing
 */
hairpin_code hairpin_rover_from_toml(const char *text, size_t length, hairpin_rover **rover, hairpin_error *error);

/**
 * Tells what a vehicle may do.
 */
hairpin_code hairpin_rover_limits(const hairpin_rover *rover, hairpin_limits *limits, hairpin_error *error);

/**
 * Gives a vehicle back; what was made with it goes on. NULL is nothing.
 */
void hairpin_rover_free(hairpin_rover *rover);

/**
 * Makes a map; the heights are copied.
 *
 * @param grid where the cells lie
 * @param heights_m columns * rows heights, row by row from the north, NaN without data
 * @param holes one of HAIRPIN_HOLES_...
 * @param map the map, to be given back to hairpin_map_free
 * @param error NULL, or where the call says why it did nothing
 */
hairpin_code hairpin_map_new(const hairpin_grid *grid,
                             const float *heights_m,
                             int32_t holes,
                             hairpin_map **map,
                             hairpin_error *error);

/**
 * Gives a map back; what was made with it goes on. NULL is nothing.
 */
void hairpin_map_free(hairpin_map *map);

/**
 * What the command `hairpin steer` looks with: 0.01 m, rad and 1/m; forward arcs; as long as it takes.
 */
hairpin_steer_settings hairpin_steer_defaults(void);

/**
 * The same with a bound on the work of a call, in counts, which are the same on every machine: docs/c.md has what it
 * costs in time, and how many goals it loses.
 */
hairpin_steer_settings hairpin_steer_fixed_budget(void);

/**
 * Makes what hairpin_steer is asked with. Vehicle and map may be given back before it.
 *
 * @param rover the vehicle
 * @param map what it drives on; NULL: the plane
 * @param settings how drives are looked for; NULL: hairpin_steer_defaults
 * @param steer what was made, to be given back to hairpin_steer_free
 * @param error NULL, or where the call says why it did nothing
 */
hairpin_code hairpin_steer_new(const hairpin_rover *rover,
                               const hairpin_map *map,
                               const hairpin_steer_settings *settings,
                               hairpin_steerer **steer,
                               hairpin_error *error);

/**
 * Gives it back. NULL is nothing.
 */
void hairpin_steer_free(hairpin_steerer *steer);

/**
 * Looks for a drive from one state to another. Takes no memory, starts no thread, reads no clock.
 *
 * What a drive lacks is an answer, in `drive`; a code other than HAIRPIN_OK is about the question. In the plane what
 * is called solved was integrated again by other equations; on a map it rests on the prediction, and hairpin_confirm
 * does so.
 *
 * @param steer what is asked
 * @param start where the vehicle is, on the map or anywhere in the plane
 * @param goal where it is to be, in the same frame
 * @param drive the answer
 * @param error NULL, or where the call says why it did nothing
 */
hairpin_code hairpin_steer(const hairpin_steerer *steer,
                           const hairpin_state *start,
                           const hairpin_state *goal,
                           hairpin_drive *drive,
                           hairpin_error *error);

/**
 * Drives what hairpin_steer found again, by an integration of its own in finer steps, and writes what that comes to
 * into `drive`: misses, largest tilt, and the status where it is not what it was said to be. Takes memory.
 *
 * @param steer what was asked
 * @param start as it was asked
 * @param goal as it was asked
 * @param drive the answer of hairpin_steer, held to what its replay comes to
 * @param error NULL, or where the call says why it did nothing
 */
hairpin_code hairpin_confirm(const hairpin_steerer *steer,
                             const hairpin_state *start,
                             const hairpin_state *goal,
                             hairpin_drive *drive,
                             hairpin_error *error);

/**
 * Looks for a drive as hairpin_steer does, and around `places`: the circle about all wheels and the underside stays
 * out of them, on a map along the predicted motion. Takes memory, and knows no budget.
 *
 * Where none stays clear the answer is HAIRPIN_INFEASIBLE with `keep_out`, and `excess` says by how many metres the
 * drive comes too near.
 *
 * @param steer what is asked
 * @param start where the vehicle is, on the map or anywhere in the plane
 * @param goal where it is to be, in the same frame
 * @param places what it keeps out of, in the same frame
 * @param count how many
 * @param drive the answer
 * @param error NULL, or where the call says why it did nothing
 */
hairpin_code hairpin_steer_clear(const hairpin_steerer *steer,
                                 const hairpin_state *start,
                                 const hairpin_state *goal,
                                 const hairpin_keep_out *places,
                                 size_t count,
                                 hairpin_drive *drive,
                                 hairpin_error *error);

/**
 * Follows a drive in steps of time: on the map with suspension, slip and lag, in the plane as it is commanded. Takes
 * memory.
 *
 * @param steer what was asked
 * @param start where the drive begins, as it was asked
 * @param drive the drive
 * @param time_step_s time between the moments, s, > 0; a drive has HAIRPIN_MOST_MOMENTS of them at most
 * @param moments where they are written
 * @param room how many there is room for
 * @param count how many there are; with too little room none is written, and this is how many it takes
 * @param error NULL, or where the call says why it did nothing
 */
hairpin_code hairpin_follow(const hairpin_steerer *steer,
                            const hairpin_state *start,
                            const hairpin_drive *drive,
                            double time_step_s,
                            hairpin_moment *moments,
                            size_t room,
                            size_t *count,
                            hairpin_error *error);

/**
 * One path between any points, each once, proven, on every core, for as long as it takes.
 */
hairpin_max_load_settings hairpin_max_load_defaults(void);

/**
 * Looks for the path of maximal total cost in which no point comes twice; points may be left out. Takes memory.
 *
 * @param costs points * points costs, row by row: from the row's point to the column's, whole numbers (um, us, counts)
 *        so that every sum is exact; HAIRPIN_NO_ARC where there is no arc
 * @param points how many points
 * @param settings what is wanted; NULL: hairpin_max_load_defaults
 * @param paths where the paths are written, the heaviest first
 * @param paths_room how many there is room for
 * @param order where the points of all paths are written, one path after the other
 * @param order_room how many there is room for: paths * points * visits does for all
 * @param answer what came of it; with too little room no path is written, and this says how many there are
 * @param error NULL, or where the call says why it did nothing
 */
hairpin_code hairpin_max_load(const int64_t *costs,
                              size_t points,
                              const hairpin_max_load_settings *settings,
                              hairpin_load_path *paths,
                              size_t paths_room,
                              size_t *order,
                              size_t order_room,
                              hairpin_max_load_answer *answer,
                              hairpin_error *error);

/**
 * Samples of times and places, deviation from legs, no limits.
 */
hairpin_judge_settings hairpin_judge_defaults(void);

/**
 * Measures a track against its waypoints and holds it to limits; a value equal to its limit keeps it. Nothing is
 * aligned: both are in one frame. Maxima are over samples. A track is within its limits where nothing is violated and
 * `measures->unmeasured` is 0. Takes memory.
 *
 * @param waypoints_m the waypoints, x, y, z each, m
 * @param waypoints how many, at least 2
 * @param samples the track
 * @param count how many samples
 * @param settings how it is judged; NULL: hairpin_judge_defaults
 * @param measures what is measured
 * @param legs NULL, or room for waypoints - 1 legs
 * @param deviations_m NULL, or room for a deviation of each sample, NaN where it does not count
 * @param found where violations are written, the gravest first; NULL: nowhere
 * @param found_room how many there is room for
 * @param violated how many there are; HAIRPIN_TOO_SMALL where there is room, but too little
 * @param error NULL, or where the call says why it did nothing
 */
hairpin_code hairpin_judge(const double *waypoints_m,
                           size_t waypoints,
                           const hairpin_sample *samples,
                           size_t count,
                           const hairpin_judge_settings *settings,
                           hairpin_measures *measures,
                           hairpin_leg *legs,
                           double *deviations_m,
                           hairpin_violation *found,
                           size_t found_room,
                           size_t *violated,
                           hairpin_error *error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* HAIRPIN_H */
