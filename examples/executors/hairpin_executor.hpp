// hairpin's executor protocol 2 for C++17, in one header without a library: `int main() { return hairpin::run<Simulator>(); }`.
// What a Simulator has, skeleton.cpp shows.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>
#include <unistd.h>

namespace hairpin {

// A value of JSON. Numbers keep their digits: seeds have 64 bits.
struct Json {
    enum Kind { Null, Bool, Number, String, Array, Object } kind = Null;
    std::string text;  // of a number, a string, a bool
    std::vector<Json> items;
    std::map<std::string, Json> fields;

    const Json &operator[](const std::string &key) const {
        static const Json none;
        auto found = fields.find(key);
        return found == fields.end() ? none : found->second;
    }
    double number(double otherwise = 0.0) const { return kind == Number ? std::strtod(text.c_str(), nullptr) : otherwise; }

    static Json parse(const std::string &line) {
        const char *at = line.c_str();
        return value(at);
    }

  private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
    static void blank(const char *&at) {
        while (is_blank(*at)) ++at;
    }
    static void expect(const char *&at, char sign) {
        blank(at);
        if (*at != sign) throw std::runtime_error(std::string("no JSON: expected ") + sign);
        ++at;
    }
    static bool more(const char *&at, char end) {
        blank(at);
        if (*at == ',') return ++at, true;
        expect(at, end);
        return false;
    }
    static std::string string(const char *&at) {
        expect(at, '"');
        std::string out;
        while (*at && *at != '"') {
            if (*at != '\\') { out += *at++; continue; }
            const char escaped = at[1];
            if (!escaped) break;
            at += 2;
            switch (escaped) {
                case 'n': out += '\n'; break;
                case 't': out += '\t'; break;
                case 'r': out += '\r'; break;
                case 'b': out += '\b'; break;
                case 'f': out += '\f'; break;
                case 'u': {
                    const unsigned code = std::strtoul(std::string(at, 4).c_str(), nullptr, 16);
                    at += 4;
                    if (code < 0x80) out += char(code);
                    else if (code < 0x800) (out += char(0xC0 | code >> 6)) += char(0x80 | (code & 0x3F));
                    else ((out += char(0xE0 | code >> 12)) += char(0x80 | (code >> 6 & 0x3F))) += char(0x80 | (code & 0x3F));
                    break;
                }
                default: out += escaped;
            }
        }
        expect(at, '"');
        return out;
    }
    static Json value(const char *&at) {
        Json out;
        blank(at);
        if (*at == '{') {
            out.kind = Object;
            ++at;
            blank(at);
            if (*at == '}') return ++at, out;
            do {
                blank(at);
                std::string key = string(at);
                expect(at, ':');
                out.fields[key] = value(at);
            } while (more(at, '}'));
        } else if (*at == '[') {
            out.kind = Array;
            ++at;
            blank(at);
            if (*at == ']') return ++at, out;
            do out.items.push_back(value(at)); while (more(at, ']'));
        } else if (*at == '"') {
            out.kind = String;
            out.text = string(at);
        } else {
            const char *from = at;
            while (*at && *at != ',' && *at != ']' && *at != '}' && !is_blank(*at)) ++at;
            out.text.assign(from, at);
            if (out.text.empty()) throw std::runtime_error("no JSON: a value is missing");
            out.kind = out.text == "null" ? Null : out.text == "true" || out.text == "false" ? Bool : Number;
        }
        return out;
    }
};

using Vector = std::array<double, 3>;

struct Pose {
    Vector p{}, v{};
    std::array<double, 4> q{1.0, 0.0, 0.0, 0.0};  // w first
    std::size_t leg = 0;
};

struct Timed {
    double t;
    Vector p, v;
};

struct Mission {
    std::vector<Vector> waypoints;
    std::vector<double> yaws;
    std::vector<Timed> timed;  // the planned motion; empty where there is none
    double accept_radius = 1.0, accept_height = 1.0, time_limit = 60.0;
    std::uint64_t seed = 0;
    Json all;  // robot, world, limits and the rest, by the protocol's names

    double limit(const std::string &name, double otherwise) const { return all["limits"][name].number(otherwise); }
};

inline Vector vector_of(const Json &json) {
    if (json.items.size() != 3) throw std::runtime_error("a place without three numbers");
    return {json.items[0].number(), json.items[1].number(), json.items[2].number()};
}

inline Mission mission_of(Json json) {
    Mission m;
    for (const Json &point : json["waypoints_m"].items) m.waypoints.push_back(vector_of(point));
    for (const Json &yaw : json["yaw_rad"].items) m.yaws.push_back(yaw.number());
    for (const Json &one : json["timed"].items) m.timed.push_back({one["t_s"].number(), vector_of(one["p_m"]), vector_of(one["v_m_s"])});
    m.accept_radius = json["accept"]["radius_m"].number(json["accept_m"].number(1.0));
    m.accept_height = json["accept"]["height_m"].number(m.accept_radius);
    m.time_limit = json["time_limit_s"].number(60.0);
    m.seed = std::strtoull(json["seed"].text.c_str(), nullptr, 10);
    m.all = std::move(json);
    return m;
}

inline std::string quoted(const std::string &text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return out + "\"";
}

// Whether the simulator says so; where it says nothing, it does.
template <class Simulator> constexpr auto wants_timed(int) -> decltype(bool(Simulator::timed)) { return Simulator::timed; }
template <class Simulator> constexpr bool wants_timed(long) { return true; }

// Speaks the protocol until `bye`. What libraries print to stdout goes to stderr, the protocol alone to stdout.
template <class Simulator> int run() {
    std::FILE *protocol = fdopen(dup(1), "w");
    dup2(2, 1);
    std::ios::sync_with_stdio(false);  // a mission is long, and read a character at a time otherwise
    std::string of, line, rows;
    const auto say = [&](const std::string &fields) {
        std::fprintf(protocol, "{%s}\n", fields.c_str());
        std::fflush(protocol);
    };
    const auto add = [&](double t, const Pose &pose) {
        char row[400];
        std::snprintf(row, sizeof row, "%s[%.9g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%zu]", rows.empty() ? "" : ",", t,
                      pose.p[0], pose.p[1], pose.p[2], pose.q[0], pose.q[1], pose.q[2], pose.q[3], pose.v[0], pose.v[1], pose.v[2], pose.leg);
        rows += row;
    };
    const auto send = [&] {
        say("\"type\":\"poses\"," + of + ",\"poses\":[" + rows + "]");
        rows.clear();
    };
    while (std::getline(std::cin, line)) {
        try {
            Json message = Json::parse(line);
            const std::string type = message["type"].text;
            if (type == "hello") {
                say("\"type\":\"ready\",\"protocol\":2,\"name\":" + quoted(Simulator::name) + ",\"version\":" + quoted(Simulator::version) +
                    ",\"deterministic\":" + (Simulator::deterministic ? "true" : "false") + ",\"timed\":" + (wants_timed<Simulator>(0) ? "true" : "false"));
            } else if (type == "reset") {
                of = "\"case\":" + quoted(message["case"].text) + ",\"run\":" + message["run"].text;
                say("\"type\":\"ready\"," + of);
            } else if (type == "mission") {
                const Mission mission = mission_of(std::move(message));
                if (mission.waypoints.size() < 2) throw std::runtime_error("a mission without waypoints");
                Simulator simulator(mission);
                rows.clear();
                add(0.0, simulator.now);
                const char *reason = nullptr;
                for (long step = 1; !reason; ++step) {
                    const double t = step * Simulator::step_s;
                    reason = t > mission.time_limit ? "time" : simulator.step();
                    add(t, simulator.now);
                    if (rows.size() > 200000 || reason) send();  // a line may have 1 MB
                }
                say("\"type\":\"end\"," + of + ",\"reason\":" + quoted(reason));
            } else if (type == "bye") {
                break;
            }
        } catch (const std::exception &why) {
            rows.clear();
            say("\"type\":\"error\"" + (of.empty() ? of : "," + of) + ",\"message\":" + quoted(why.what()));
        }
    }
    return 0;
}

}  // namespace hairpin
