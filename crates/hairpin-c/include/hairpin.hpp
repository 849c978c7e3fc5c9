// hairpin for C++17: hairpin.h with handles that give themselves back, vectors for results, and exceptions for codes.
#ifndef HAIRPIN_HPP
#define HAIRPIN_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hairpin.h"

namespace hairpin {

/// Why a call did nothing: a code of hairpin.h and its sentence.
class error : public std::runtime_error {
public:
    explicit error(const hairpin_error &of) : std::runtime_error(of.message), code_(of.code) {}
    hairpin_code code() const noexcept { return code_; }

private:
    hairpin_code code_;
};

namespace detail {

inline void check(hairpin_code code, const hairpin_error &why)
{
    if (code != HAIRPIN_OK) {
        throw error(why);
    }
}

/// A handle, and what gives it back.
template <class T, void (*give_back)(T *)> struct owner {
    void operator()(T *handle) const noexcept { give_back(handle); }
    using handle = std::unique_ptr<T, owner>;
};

} // namespace detail

/// A vehicle.
class rover {
public:
    /// A point in the plane with these bounds, 1/m and 1/m^2.
    rover(double max_curvature_1_m, double max_curvature_rate_1_m2)
    {
        hairpin_error why;
        hairpin_rover *made = nullptr;
        detail::check(hairpin_rover_new(max_curvature_1_m, max_curvature_rate_1_m2, &made, &why), why);
        handle_.reset(made);
    }

    /// The vehicle of a robot file's text.
    explicit rover(const std::string &toml)
    {
        hairpin_error why;
        hairpin_rover *made = nullptr;
        detail::check(hairpin_rover_from_toml(toml.data(), toml.size(), &made, &why), why);
        handle_.reset(made);
    }

    hairpin_limits limits() const
    {
        hairpin_error why;
        hairpin_limits told;
        detail::check(hairpin_rover_limits(get(), &told, &why), why);
        return told;
    }

    const hairpin_rover *get() const noexcept { return handle_.get(); }

private:
    detail::owner<hairpin_rover, hairpin_rover_free>::handle handle_;
};

/// An elevation map.
class map {
public:
    /// columns * rows heights, row by row from the north, m.
    map(const hairpin_grid &grid, const std::vector<float> &heights_m, std::int32_t holes = HAIRPIN_HOLES_REFUSED)
    {
        if (grid.columns != 0 && (heights_m.size() % grid.columns != 0 || heights_m.size() / grid.columns != grid.rows)) {
            throw std::invalid_argument("heights_m: must be columns * rows of them");
        }
        hairpin_error why;
        hairpin_map *made = nullptr;
        detail::check(hairpin_map_new(&grid, heights_m.data(), holes, &made, &why), why);
        handle_.reset(made);
    }

    const hairpin_map *get() const noexcept { return handle_.get(); }

private:
    detail::owner<hairpin_map, hairpin_map_free>::handle handle_;
};

/// What finds drives. Any number of threads may ask it at once.
class steerer {
public:
    /// In the plane.
    explicit steerer(const rover &of, const hairpin_steer_settings &settings = hairpin_steer_defaults())
    {
        make(of, nullptr, settings);
    }

    /// On a map.
    steerer(const rover &of, const map &on, const hairpin_steer_settings &settings = hairpin_steer_defaults())
    {
        make(of, on.get(), settings);
    }

    /// A drive from start to goal; takes no memory.
    hairpin_drive operator()(const hairpin_state &start, const hairpin_state &goal) const
    {
        hairpin_error why;
        hairpin_drive drive;
        detail::check(hairpin_steer(handle_.get(), &start, &goal, &drive, &why), why);
        return drive;
    }

    /// The same around places; takes memory.
    hairpin_drive clear_of(const std::vector<hairpin_keep_out> &places, const hairpin_state &start,
                           const hairpin_state &goal) const
    {
        hairpin_error why;
        hairpin_drive drive;
        const auto code =
            hairpin_steer_clear(handle_.get(), &start, &goal, places.data(), places.size(), &drive, &why);
        detail::check(code, why);
        return drive;
    }

    /// The drive, held to its replay.
    hairpin_drive confirm(const hairpin_state &start, const hairpin_state &goal, hairpin_drive drive) const
    {
        hairpin_error why;
        detail::check(hairpin_confirm(handle_.get(), &start, &goal, &drive, &why), why);
        return drive;
    }

    /// The moments of a drive.
    std::vector<hairpin_moment> follow(const hairpin_state &start, const hairpin_drive &drive, double time_step_s) const
    {
        hairpin_error why;
        std::vector<hairpin_moment> path(256);
        for (;;) {
            std::size_t count = 0;
            const auto code =
                hairpin_follow(handle_.get(), &start, &drive, time_step_s, path.data(), path.size(), &count, &why);
            if (code != HAIRPIN_TOO_SMALL) {
                detail::check(code, why);
                path.resize(count);
                return path;
            }
            path.resize(count);
        }
    }

private:
    void make(const rover &of, const hairpin_map *on, const hairpin_steer_settings &settings)
    {
        hairpin_error why;
        hairpin_steerer *made = nullptr;
        detail::check(hairpin_steer_new(of.get(), on, &settings, &made, &why), why);
        handle_.reset(made);
    }

    detail::owner<hairpin_steerer, hairpin_steer_free>::handle handle_;
};

/// A path through points, and its cost.
struct load_path {
    std::int64_t cost;
    std::vector<std::size_t> points;
};

/// The heaviest paths.
struct load {
    std::int32_t status;
    bool proven;
    std::int64_t bound;
    std::vector<load_path> paths;
};

/// The heaviest paths through points * points costs, row = from.
inline load max_load(const std::vector<std::int64_t> &costs, std::size_t points,
                     const hairpin_max_load_settings &settings = hairpin_max_load_defaults())
{
    if (points == 0 || costs.size() % points != 0 || costs.size() / points != points) {
        throw std::invalid_argument("costs: must be points * points of them");
    }
    hairpin_error why;
    hairpin_max_load_answer answer;
    std::vector<hairpin_load_path> paths(settings.paths > 0 ? settings.paths : 1);
    std::vector<std::size_t> order(paths.size() * points * (settings.visits > 0 ? settings.visits : 1));
    detail::check(hairpin_max_load(costs.data(), points, &settings, paths.data(), paths.size(), order.data(),
                                   order.size(), &answer, &why),
                  why);
    load found{answer.status, answer.proven != 0, answer.bound, {}};
    for (std::size_t i = 0; i < answer.paths; ++i) {
        const auto begin = order.begin() + static_cast<std::ptrdiff_t>(paths[i].first);
        found.paths.push_back({paths[i].cost, {begin, begin + static_cast<std::ptrdiff_t>(paths[i].count)}});
    }
    return found;
}

/// x, y, z, m.
using point = std::array<double, 3>;

/// What a track was found to be.
struct judgement {
    hairpin_measures measures;
    std::vector<hairpin_leg> legs;
    std::vector<double> deviations_m;
    std::vector<hairpin_violation> violations;

    /// Whether it is within its limits: nothing is violated, and all that has a limit was measured.
    bool within() const
    {
        return violations.empty() && measures.unmeasured == 0;
    }
};

/// Holds a track to its waypoints and limits.
inline judgement judge(const std::vector<point> &waypoints, const std::vector<hairpin_sample> &samples,
                       const hairpin_judge_settings &settings = hairpin_judge_defaults())
{
    hairpin_error why;
    judgement told;
    told.legs.resize(waypoints.empty() ? 0 : waypoints.size() - 1);
    told.deviations_m.resize(samples.size());
    told.violations.resize(16); // more than there are kinds of them
    std::size_t violated = 0;
    const double *places = waypoints.empty() ? nullptr : waypoints.front().data();
    detail::check(hairpin_judge(places, waypoints.size(), samples.data(), samples.size(), &settings, &told.measures,
                                told.legs.data(), told.deviations_m.data(), told.violations.data(),
                                told.violations.size(), &violated, &why),
                  why);
    told.violations.resize(violated);
    return told;
}

} // namespace hairpin

#endif
