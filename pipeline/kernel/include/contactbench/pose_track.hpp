// Where a tool was, is, or is about to be: the poses of a robot or tracker, asked at any time.
//
// Between two poses no more than `longest_gap` apart: the shortest turn, and a straight line. After the last one, or in
// a longer gap: carried on by the last twist, for at most `longest_ahead`. Before the first one, and beyond that:
// nothing. A recording and a live stream follow the same rule; only live, the next pose is not there yet.
//
// Contract: R turns the tool's frame into W, row major; p is its origin in W, m, NaN where it is not known; times in s.
// Nothing here allocates or throws. One writer; not thread-safe.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vec.hpp"

namespace contactbench {

struct Pose {
    double time = 0.0;
    double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double p[3] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
                   std::numeric_limits<double>::quiet_NaN()};
};

struct PosePolicy {
    double longest_gap = 0.25;    // s
    double longest_ahead = 0.15;  // s: poses of 10 Hz with jitter still cover every sample
};

namespace detail {

// A twist over less than this would mostly be the poses' noise.
inline constexpr double twist_span = 0.04;
// Beyond, rad, the shortest turn between two poses is no twist to go on with.
inline constexpr double largest_turn = 1.5;

// product = A^T B or A B, row major; `product` is neither.
inline void transpose_times(const double A[9], const double B[9], double product[9]) {
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            product[3 * r + c] = A[r] * B[c] + A[3 + r] * B[3 + c] + A[6 + r] * B[6 + c];
}
inline void times(const double A[9], const double B[9], double product[9]) {
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            product[3 * r + c] = A[3 * r] * B[c] + A[3 * r + 1] * B[3 + c] + A[3 * r + 2] * B[6 + c];
}

// R v
inline Vec3 turned(const double R[9], Vec3 v) {
    return {R[0] * v.x + R[1] * v.y + R[2] * v.z, R[3] * v.x + R[4] * v.y + R[5] * v.z,
            R[6] * v.x + R[7] * v.y + R[8] * v.z};
}

// The rotation vector of R, rad; of a half turn the axis is lost.
inline Vec3 rotation_vector(const double R[9]) {
    const Vec3 v{0.5 * (R[7] - R[5]), 0.5 * (R[2] - R[6]), 0.5 * (R[3] - R[1])};
    const double s = norm(v), c = 0.5 * (R[0] + R[4] + R[8] - 1.0);
    return s > 1e-12 ? (std::atan2(s, c) / s) * v : v;
}

inline void rotation_of(Vec3 w, double R[9]) {
    const double a2 = norm2(w), a = std::sqrt(a2);
    // sin(a) / a and (1 - cos(a)) / a^2
    const double s = a > 1e-4 ? std::sin(a) / a : 1.0 - a2 / 6.0;
    const double h = a > 1e-4 ? (1.0 - std::cos(a)) / a2 : 0.5 - a2 / 24.0;
    const double x = w.x, y = w.y, z = w.z;
    R[0] = 1.0 - h * (y * y + z * z), R[1] = h * x * y - s * z, R[2] = h * x * z + s * y;
    R[3] = h * x * y + s * z, R[4] = 1.0 - h * (x * x + z * z), R[5] = h * y * z - s * x;
    R[6] = h * x * z - s * y, R[7] = h * y * z + s * x, R[8] = 1.0 - h * (x * x + y * y);
}

inline Vec3 turn_between(const Pose& a, const Pose& b) {
    double way[9];
    transpose_times(a.R, b.R, way);
    return rotation_vector(way);
}

// `from`, moved by `share` of the way from `a` to `b`, which is a turn by `turn`.
inline void move(const Pose& from, const Pose& a, const Pose& b, Vec3 turn, double share, double time, Pose& out) {
    double step[9];
    rotation_of(share * turn, step);
    times(from.R, step, out.R);
    for (int i = 0; i < 3; ++i) out.p[i] = from.p[i] + share * (b.p[i] - a.p[i]);
    out.time = time;
}

}  // namespace detail

// The pose at `time` among `count` poses of increasing times, `at(i)` giving the i-th. `base`: the last one that is not
// later than `time`, or -1 if there is none. Returns false where nothing is known.
template <class At>
bool pose_at(At&& at, std::ptrdiff_t count, std::ptrdiff_t base, double time, const PosePolicy& policy, Pose& out) {
    if (base < 0) return false;
    const Pose& last = at(base);
    if (last.time == time) return out = last, true;
    if (base + 1 < count) {
        const Pose& next = at(base + 1);
        const double gap = next.time - last.time;
        if (gap <= policy.longest_gap) {
            detail::move(last, last, next, detail::turn_between(last, next), (time - last.time) / gap, time, out);
            return true;
        }
    }
    const double ahead = time - last.time;
    if (!(ahead <= policy.longest_ahead)) return false;
    std::ptrdiff_t before = base;
    while (before > 0 && last.time - at(before).time < detail::twist_span &&
           at(before).time - at(before - 1).time <= policy.longest_gap)
        --before;
    if (before == base) {  // a first pose has no twist: it is held
        out = last;
        out.time = time;
        return true;
    }
    const Pose& from = at(before);
    const Vec3 turn = detail::turn_between(from, last);
    if (!(norm(turn) <= detail::largest_turn)) return false;
    // Poses nearer together than a twist is good for, with none before them: their noise is not made larger.
    const double span = std::max(last.time - from.time, detail::twist_span);
    detail::move(last, from, last, turn, ahead / span, time, out);
    return true;
}

// The newest poses of a stream.
class PoseTrack {
public:
    // Returns false for a pose that is not used: not finite, or not later than the last one. One that is earlier by
    // more than the longest gap says that the clock was set back: the track begins anew with it.
    bool add(const Pose& pose, const PosePolicy& policy) {
        bool known = std::isfinite(pose.time);
        for (const double x : pose.R) known &= std::isfinite(x);
        if (!known) return false;
        if (count_ > 0 && pose.time <= newest().time) {
            if (newest().time - pose.time <= policy.longest_gap) return false;
            clear();
        }
        ring_[(first_ + count_) % capacity] = pose;
        if (count_ < capacity) ++count_;
        else first_ = (first_ + 1) % capacity;
        return true;
    }

    bool at(double time, const PosePolicy& policy, Pose& out, double& age) const {
        // Nearly always the last or one of the last few.
        std::ptrdiff_t base = count_ - 1;
        while (base >= 0 && (*this)[base].time > time) --base;
        if (base >= 0) age = time - (*this)[base].time;
        return pose_at([this](std::ptrdiff_t i) -> const Pose& { return (*this)[i]; }, count_, base, time, policy, out);
    }

    void clear() { first_ = count_ = 0; }
    std::ptrdiff_t count() const { return count_; }
    const Pose& newest() const { return (*this)[count_ - 1]; }
    const Pose& operator[](std::ptrdiff_t i) const { return ring_[(first_ + i) % capacity]; }

private:
    static constexpr std::ptrdiff_t capacity = 512;  // a second at 500 Hz: as late as samples may be
    std::array<Pose, std::size_t(capacity)> ring_{};
    std::ptrdiff_t first_ = 0, count_ = 0;
};

}  // namespace contactbench
