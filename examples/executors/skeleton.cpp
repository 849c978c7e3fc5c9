// An executor to begin with: replace `Simulator`, keep hairpin_executor.hpp. Protocol 2, C++17, no library.
//
//     g++ -std=c++17 -O2 -o skeleton examples/executors/skeleton.cpp
//     hairpin check-executor ./skeleton
#include "hairpin_executor.hpp"

// ---- yours: a point with drag that chases the next waypoint
struct Simulator {
    static constexpr const char *name = "C++ skeleton", *version = "1";
    static constexpr bool deterministic = true, timed = false;  // whether mission.timed is wanted: it is long
    static constexpr double step_s = 0.02;
    hairpin::Mission mission;
    hairpin::Pose now;
    // At rest at the first waypoint. Draw all noise from mission.seed, and it is deterministic.
    explicit Simulator(const hairpin::Mission &m) : mission(m) { now.p = m.waypoints.front(); }
    // Controller and dynamics, one step on. Gives why the flight is over, or nullptr.
    const char *step() {
        const auto &goal = mission.waypoints[now.leg + 1];
        double away[3], distance = 0.0;
        for (int i = 0; i < 3; ++i) away[i] = goal[i] - now.p[i], distance += away[i] * away[i];
        if (std::hypot(away[0], away[1]) <= mission.accept_radius && std::abs(away[2]) <= mission.accept_height) {
            if (now.leg + 2 == mission.waypoints.size()) return "done";
            ++now.leg;
        }
        const double pull = std::min(1.2, std::min(mission.limit("max_speed_m_s", 8.0), 8.0) / std::sqrt(distance + 1e-18));
        for (int i = 0; i < 3; ++i) {
            now.v[i] += step_s * 2.0 * (pull * away[i] - now.v[i]);
            now.p[i] += step_s * now.v[i];
        }
        return nullptr;
    }
};
// ---- the rest is hairpin_executor.hpp

int main() { return hairpin::run<Simulator>(); }
