// What a cell's controller and a flight computer ask: the heaviest program through points, and whether a track was good.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "hairpin.hpp"

int main()
{
    try {
        // Five points on a line, at 0, 1, 5, 12 and 20 mm: what is moved between them in micrometres.
        const std::int64_t at[] = {0, 1000, 5000, 12000, 20000};
        std::vector<std::int64_t> costs;
        for (auto from : at) {
            for (auto to : at) {
                costs.push_back(from == to ? HAIRPIN_NO_ARC : std::abs(from - to));
            }
        }
        const auto load = hairpin::max_load(costs, 5);
        std::printf("%lld um%s:", static_cast<long long>(load.paths.at(0).cost), load.proven ? ", proven" : "");
        for (auto point : load.paths.at(0).points) {
            std::printf(" %zu", point);
        }
        std::printf("\n");

        // Along both legs at 1 m/s, carried 0.8 m beyond the corner and back.
        const std::vector<hairpin::point> waypoints = {{0, 0, 2}, {10, 0, 2}, {10, 10, 2}};
        std::vector<hairpin_sample> track;
        for (int i = 0; i <= 200; ++i) {
            const double t = i / 10.0, beyond = t > 10 && t <= 12 ? 0.8 * std::sin((t - 10) * 1.5707963267948966) : 0;
            hairpin_sample sample = {};
            sample.t_s = t;
            sample.position_m[0] = t <= 10 ? t : 10 + beyond;
            sample.position_m[1] = t <= 10 ? 0 : t - 10;
            sample.position_m[2] = 2;
            sample.leg = t > 10;
            track.push_back(sample);
        }
        auto settings = hairpin_judge_defaults();
        settings.told = HAIRPIN_TOLD_LEG;
        settings.max_deviation_m = 0.5;
        const auto judged = hairpin::judge(waypoints, track, settings);
        std::printf("worst %.2f m at %.1f s on leg %zu\n", judged.measures.max_deviation_m, judged.measures.t_worst_s,
                    judged.measures.leg_worst);
        for (const auto &violation : judged.violations) {
            std::printf("%s %.2f, limit %.2f\n", violation.what, violation.value, violation.limit);
        }

        // Everything is given back at the end of its scope; what is refused is thrown.
        const hairpin::rover car(0.2, 0.1);
        const hairpin::steerer steer(car);
        const auto drive = steer({0, 0, 0, 0}, {20, 4, 0, 0});
        std::printf("%.2f m to the lane beside\n", drive.length_m);
        try {
            steer({0, 0, 0, 0}, {std::nan(""), 4, 0, 0});
        } catch (const hairpin::error &refused) {
            std::printf("refused: %s\n", refused.what());
        }
        return judged.violations.size() == 1 && !judged.within() && drive.status == HAIRPIN_SOLVED ? 0 : 1;
    } catch (const hairpin::error &error) {
        std::fprintf(stderr, "code %d: %s\n", error.code(), error.what());
        return 2;
    }
}
