// The skirt scene without any engine: the cloth's vertices, the body and its motion, and the measures of a frame.
// Everything is in double precision, y up, in metres and seconds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace scene {

constexpr double kPi = 3.14159265358979323846;
constexpr double kStep = 1.0 / 120.0;
constexpr double kMass = 0.31;
constexpr double kGravity = 9.81;
constexpr double kFriction = 0.3;
constexpr int kWarmUp = 240;

struct Vec {
    double x = 0, y = 0, z = 0;
};

inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(double s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(Vec a) { return std::sqrt(dot(a, a)); }
inline bool finite(Vec a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

inline Vec turn_x(double angle, Vec p) {
    const double s = std::sin(angle), c = std::cos(angle);
    return {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
}

inline Vec turn_y(double angle, Vec p) {
    const double s = std::sin(angle), c = std::cos(angle);
    return {c * p.x + s * p.z, p.y, c * p.z - s * p.x};
}

// The body: joint spheres and the tapered capsules between them.

struct Joint {
    Vec at;
    double radius;
};

constexpr int kJoints = 16;
constexpr int kCapsules = 28;

inline const std::array<Joint, kJoints> &joints() {
    static const std::array<Joint, kJoints> all = {{
        {{0, 1, 0}, .14},        {{0, 1.2, 0}, .13},      {{0, 1.4, 0}, .14},     {{0, 1.55, 0}, .06},
        {{0, 1.7, 0}, .10},      {{.10, .95, 0}, .11},    {{-.10, .95, 0}, .11},  {{.11, .52, 0}, .07},
        {{-.11, .52, 0}, .07},   {{.11, .10, 0}, .05},    {{-.11, .10, 0}, .05},  {{.18, 1.45, 0}, .07},
        {{-.18, 1.45, 0}, .07},  {{.38, 1.2, 0}, .05},    {{-.38, 1.2, 0}, .05},  {{0, 1.1, .03}, .12},
    }};
    return all;
}

inline const std::array<std::array<int, 2>, kCapsules> &capsules() {
    static const std::array<std::array<int, 2>, kCapsules> all = {{
        {0, 1},  {1, 2},   {2, 3},   {3, 4},  {0, 5},  {0, 6},   {5, 7},   {6, 8},   {7, 9},  {8, 10},
        {2, 11}, {2, 12},  {11, 13}, {12, 14}, {5, 6}, {1, 5},   {1, 6},   {1, 11},  {1, 12}, {11, 12},
        {0, 15}, {15, 1},  {15, 5},  {15, 6}, {15, 2}, {3, 11},  {3, 12},  {0, 2},
    }};
    return all;
}

enum class Motion { walk, fast, settled };

inline bool motion_from(const std::string &name, Motion &motion) {
    static const char *names[] = {"walk", "fast", "settled"};
    for (int i = 0; i < 3; ++i)
        if (name == names[i]) {
            motion = static_cast<Motion>(i);
            return true;
        }
    return false;
}

// Where the body is at one time.
struct Pose {
    double yaw = 0;
    Vec root;
    // The turn about x of the limb that ends in a joint, before the yaw; 0 for the joints of the trunk.
    std::array<double, kJoints> limb{};
    std::array<Vec, kJoints> joint{};

    // The root's motion, which also moves the pinned ring.
    Vec place(Vec p) const { return turn_y(yaw, p) + root; }
};

inline Pose pose(Motion motion, double time) {
    struct Amplitudes {
        double hertz, leg, sway, yaw, bob;
    };
    static const Amplitudes all[] = {{1, 30, .05, 10, .02}, {2, 50, .10, 45, .02}, {0, 0, 0, 0, 0}};
    const Amplitudes &of = all[static_cast<int>(motion)];
    const double ramp = std::min(1.0, time), phase = 2 * kPi * of.hertz * time;
    const double leg = ramp * of.leg * kPi / 180, sway = ramp * of.sway;
    Pose pose;
    pose.yaw = ramp * of.yaw * kPi / 180 * std::sin(phase);
    pose.root = {sway * std::sin(phase), ramp * of.bob * std::cos(2 * phase), sway * std::cos(phase) - sway};
    std::array<Vec, kJoints> at;
    for (int i = 0; i < kJoints; ++i) at[i] = joints()[i].at;
    for (int side = 0; side < 2; ++side) {
        const int hip = 5 + side, knee = 7 + side, ankle = 9 + side, shoulder = 11 + side, elbow = 13 + side;
        const double swing = (side == 0 ? leg : -leg) * std::sin(phase);
        pose.limb[knee] = -swing;
        pose.limb[ankle] = -swing + .6 * leg * (1 + std::sin(phase + side * kPi));
        pose.limb[elbow] = swing;
        const auto moved = [&](int from, int to) {
            return at[from] + turn_x(pose.limb[to], joints()[to].at - joints()[from].at);
        };
        at[knee] = moved(hip, knee);
        at[ankle] = moved(knee, ankle);
        at[elbow] = moved(shoulder, elbow);
    }
    for (int i = 0; i < kJoints; ++i) pose.joint[i] = pose.place(at[i]);
    return pose;
}

// Signed distance from the hull of two spheres. The sphere of that hull that is nearest to a point is found by going
// from the point along the hull's normal to the axis.
inline double round_cone(Vec p, Vec a, double ra, Vec b, double rb) {
    const Vec axis = b - a;
    const double span = length(axis), taper = ra - rb;
    if (span <= std::fabs(taper)) return ra > rb ? length(p - a) - ra : length(p - b) - rb;
    const double along = dot(p - a, axis) / span;
    const double across = std::sqrt(std::max(0.0, dot(p - a, p - a) - along * along));
    const double tangent = taper / std::sqrt(span * span - taper * taper);
    const double t = std::clamp((along - across * tangent) / span, 0.0, 1.0);
    return length(p - (a + t * axis)) - (ra - t * taper);
}

// The cloth.

struct Skirt {
    int side;
    std::vector<Vec> rest;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    std::uint32_t at(int row, int column) const { return std::uint32_t(row * side + column % side); }

    explicit Skirt(int n) : side(n) {
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const double u = double(i) / (n - 1), angle = 2 * kPi * j / n, r = .18 + .24 * u;
                rest.push_back({r * std::cos(angle), 1.08 - .78 * u, r * std::sin(angle)});
            }
        for (int i = 0; i + 1 < n; ++i)
            for (int j = 0; j < n; ++j) add_quad(i, j);
    }

private:
    void add_quad(int i, int j) {
        const std::uint32_t a = at(i, j), b = at(i, j + 1), c = at(i + 1, j + 1), d = at(i + 1, j);
        if ((i + j) % 2 != 0) {
            triangles.push_back({a, b, c});
            triangles.push_back({a, c, d});
        } else {
            triangles.push_back({a, b, d});
            triangles.push_back({b, c, d});
        }
    }
};

// What the frames so far show.
struct Measures {
    double strain_mean = 0, strain_p99 = 0;  // Means over the frames.
    double stretch_max = 0, compression_max = 0;
    double deepest = 0, inside = 0;  // m; mean share of the vertices.
    double hem_highest = -1e30, hem_lowest = 1e30;  // Below the pinned ring (m), as a difference of heights.
    std::size_t nonfinite = 0, frames = 0;
};

class Gauge {
public:
    explicit Gauge(const Skirt &skirt) : skirt_(skirt) {
        // The edges of the pinned ring cannot stretch, so counting them would flatter the engine.
        for (int i = 0; i < skirt.side; ++i)
            for (int j = 0; j < skirt.side; ++j) {
                if (i > 0) add(skirt.at(i, j), skirt.at(i, j + 1));
                if (i + 1 < skirt.side) add(skirt.at(i, j), skirt.at(i + 1, j));
            }
        strain_.resize(edges_.size());
    }

    void read(const std::vector<Vec> &now, const Pose &pose) {
        strain(now);
        depth(now, pose);
        const double ring = pose.place(skirt_.rest[0]).y;
        for (int j = 0; j < skirt_.side; ++j) {
            const double below = now[skirt_.at(skirt_.side - 1, j)].y - ring;
            sum_.hem_highest = std::max(sum_.hem_highest, below);
            sum_.hem_lowest = std::min(sum_.hem_lowest, below);
        }
        sum_.frames += 1;
    }

    Measures result() const {
        Measures mean = sum_;
        const double frames = double(std::max<std::size_t>(1, sum_.frames));
        mean.strain_mean /= frames;
        mean.strain_p99 /= frames;
        mean.inside /= frames * double(skirt_.rest.size());
        return mean;
    }

private:
    struct Edge {
        std::uint32_t a, b;
        double rest;
    };

    void add(std::uint32_t a, std::uint32_t b) {
        edges_.push_back({a, b, length(skirt_.rest[a] - skirt_.rest[b])});
    }

    void strain(const std::vector<Vec> &now) {
        double sum = 0;
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            const double stretch = length(now[edges_[e].a] - now[edges_[e].b]) / edges_[e].rest - 1;
            strain_[e] = std::fabs(stretch);
            sum += strain_[e];
            sum_.stretch_max = std::max(sum_.stretch_max, stretch);
            sum_.compression_max = std::max(sum_.compression_max, -stretch);
        }
        const auto rank = strain_.begin() + std::ptrdiff_t((strain_.size() - 1) * 99 / 100);
        std::nth_element(strain_.begin(), rank, strain_.end());
        sum_.strain_mean += sum / double(edges_.size());
        sum_.strain_p99 += *rank;
    }

    void depth(const std::vector<Vec> &now, const Pose &pose) {
        for (std::size_t v = 0; v < now.size(); ++v) {
            if (!finite(now[v])) sum_.nonfinite += 1;
            if (v < std::size_t(skirt_.side)) continue;
            double distance = 0;
            for (const auto &[a, b] : capsules())
                distance = std::min(
                    distance, round_cone(now[v], pose.joint[a], joints()[a].radius, pose.joint[b], joints()[b].radius));
            sum_.deepest = std::max(sum_.deepest, -distance);
            // A hundred times the last bit of a float at this size counts as touching.
            sum_.inside += distance < -1e-5 ? 1 : 0;
        }
    }

    const Skirt &skirt_;
    std::vector<Edge> edges_;
    std::vector<double> strain_;
    Measures sum_;
};

// The value below which a share of the values lies.
inline double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const auto rank = values.begin() + std::ptrdiff_t(double(values.size() - 1) * share + .5);
    std::nth_element(values.begin(), rank, values.end());
    return *rank;
}

}  // namespace scene
