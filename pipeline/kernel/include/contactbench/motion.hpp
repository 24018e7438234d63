// How a tool is moved, from its poses: what its mass alone does to the sensor while it is accelerated.
//
// A cubic through the last poses (Savitzky and Golay's filter, for any spacing), asked at the sample's time; the scatter
// about it says how well the acceleration is known. Acceleration that could be the poses' noise counts as little
// (positive-part James and Stein). A sample that comes late is asked for with the poses around it.
//
// Poses that come too slowly for a cubic show at least how hard the tool is accelerated: by how much the path bends. That
// is no acceleration to go by, but makes the wrench as uncertain as it is.
//
// Contract: W frame, m, s, rad. Only poses with a position.
#pragma once

#include "pose_track.hpp"

namespace contactbench {

struct MotionSettings {
    bool on = false;
    double window = 0.15;     // s
    double gyration = 0.035;  // m: radius of gyration of the tool about its centre of mass, roughly
};

struct Motion {
    Vec3 acceleration;      // of the pose's origin, m/s^2
    Vec3 spin, spin_rate;   // rad/s, rad/s^2
    double sigma = 0.0;     // of the acceleration, one axis, m/s^2
};

class MotionFit {
public:
    // Fits the poses of a window that ends at `end`, s, or with the newest pose.
    void see(const PoseTrack& track, const PosePolicy& policy, double window, double end) noexcept {
        known_ = false;
        std::ptrdiff_t n = track.count();
        while (n > 0 && track[n - 1].time > end) --n;
        if (n == 0) return;
        const Pose& newest = track[n - 1];
        std::ptrdiff_t first = n;
        while (first > 0 && newest.time - track[first - 1].time <= window && std::isfinite(track[first - 1].p[0])) --first;
        const std::ptrdiff_t used = n - first;
        if (used < fewest || newest.time - track[first].time < 0.7 * window) return look_for_bends(track, policy, n);
        double A[order][order] = {}, B[order][6] = {};
        for (std::ptrdiff_t i = first; i < n; ++i) {
            double basis[order], y[6];
            row(track[i], newest, window, basis, y);
            for (int r = 0; r < order; ++r) {
                for (int c = 0; c < order; ++c) A[r][c] += basis[r] * basis[c];
                for (int c = 0; c < 6; ++c) B[r][c] += basis[r] * y[c];
            }
        }
        if (!solve(A, B)) return look_for_bends(track, policy, n);
        double left = 0.0;
        for (std::ptrdiff_t i = first; i < n; ++i) {
            double basis[order], y[6];
            row(track[i], newest, window, basis, y);
            for (int c = 0; c < 3; ++c) {
                double fit = 0.0;
                for (int r = 0; r < order; ++r) fit += basis[r] * coefficient_[r][c];
                left += (y[c] - fit) * (y[c] - fit);
            }
        }
        variance_ = std::max(left / (3.0 * double(used - order)), finest * finest);
        time_ = newest.time, window_ = window;
        std::copy(newest.R, newest.R + 9, R_);
        known_ = cubic_ = true;
    }

    void reset() noexcept { known_ = false; }

    bool at(double time, const PosePolicy& policy, Motion& out) const noexcept {
        if (!known_ || !(time - time_ <= policy.longest_ahead)) return false;
        if (!cubic_) {
            out = Motion{};
            out.sigma = bend_;
            return time_ - time <= policy.longest_gap;
        }
        const double u = (time - time_) / window_;
        if (u < -1.0) return false;
        const double first[order] = {0.0, 1.0 / window_, 2.0 * u / window_, 3.0 * u * u / window_};
        const double second[order] = {0.0, 0.0, 2.0 / (window_ * window_), 6.0 * u / (window_ * window_)};
        double a[3] = {}, spin[3] = {}, rate[3] = {}, spread = 0.0;
        for (int r = 0; r < order; ++r)
            for (int c = 0; c < 3; ++c) {
                a[c] += second[r] * coefficient_[r][c];
                spin[c] += first[r] * coefficient_[r][3 + c], rate[c] += second[r] * coefficient_[r][3 + c];
            }
        for (int r = 0; r < order; ++r)
            for (int c = 0; c < order; ++c) spread += second[r] * inverse_[r][c] * second[c];
        const double variance = spread * variance_;
        const Vec3 seen{a[0], a[1], a[2]};
        const double size2 = norm2(seen);
        const double share = size2 > doubt * variance ? 1.0 - doubt * variance / size2 : 0.0;
        out.acceleration = share * seen;
        out.spin = detail::turned(R_, {spin[0], spin[1], spin[2]});
        out.spin_rate = detail::turned(R_, {rate[0], rate[1], rate[2]});
        out.sigma = std::sqrt(variance + unfollowed * unfollowed * size2);
        // Positions that no robot can have taken are none.
        return size2 <= hardest * hardest && out.sigma <= hardest;
    }

private:
    static constexpr int order = 4;
    static constexpr std::ptrdiff_t fewest = 8;
    static constexpr double doubt = 8.0;       // standing still passes it once in 20 times
    static constexpr double hardest = 100.0;   // m/s^2
    static constexpr double bend_span = 0.07;  // s: over less, a bend is the noise of the positions
    static constexpr double finest = 2e-5;  // m: what no robot resolves
    // Share of an acceleration that a cubic does not follow: of a swing at 1 Hz, over the usual window.
    static constexpr double unfollowed = 0.1;

    // The sharpest of the last two bends of the path, through poses at least `bend_span` apart.
    void look_for_bends(const PoseTrack& track, const PosePolicy& policy, std::ptrdiff_t n) noexcept {
        const Pose* node[4] = {&track[n - 1]};
        int count = std::isfinite(node[0]->p[0]) ? 1 : 0;
        for (std::ptrdiff_t i = n - 1; count > 0 && count < 4 && i > 0; --i) {
            const Pose& before = track[i - 1];
            if (track[i].time - before.time > policy.longest_gap || !std::isfinite(before.p[0])) break;
            if (node[count - 1]->time - before.time >= bend_span) node[count++] = &before;
        }
        bend_ = 0.0;
        for (int i = 0; i + 2 < count; ++i) {
            const double late = node[i]->time - node[i + 1]->time, early = node[i + 1]->time - node[i + 2]->time;
            double square = 0.0;
            for (int c = 0; c < 3; ++c) {
                const double a = (node[i]->p[c] - node[i + 1]->p[c]) / late, b = (node[i + 1]->p[c] - node[i + 2]->p[c]) / early;
                square += 4.0 * (a - b) * (a - b) / ((late + early) * (late + early));
            }
            bend_ = std::max(bend_, std::sqrt(square));
        }
        time_ = node[0]->time;
        cubic_ = false;
        known_ = count > 2 && bend_ <= hardest;
    }

    static void row(const Pose& pose, const Pose& newest, double window, double basis[order], double y[6]) noexcept {
        const double u = (pose.time - newest.time) / window;
        basis[0] = 1.0, basis[1] = u, basis[2] = u * u, basis[3] = u * u * u;
        for (int c = 0; c < 3; ++c) y[c] = pose.p[c] - newest.p[c];
        const Vec3 w = detail::turn_between(newest, pose);
        y[3] = w.x, y[4] = w.y, y[5] = w.z;
    }

    // Gauss and Jordan's, on a small positive definite matrix: inverse_ and coefficient_.
    bool solve(double (&A)[order][order], const double (&B)[order][6]) noexcept {
        for (int r = 0; r < order; ++r)
            for (int c = 0; c < order; ++c) inverse_[r][c] = r == c;
        for (int k = 0; k < order; ++k) {
            if (!(A[k][k] > 1e-12)) return false;
            const double scale = 1.0 / A[k][k];
            for (int c = 0; c < order; ++c) A[k][c] *= scale, inverse_[k][c] *= scale;
            for (int r = 0; r < order; ++r) {
                if (r == k) continue;
                const double f = A[r][k];
                for (int c = 0; c < order; ++c) A[r][c] -= f * A[k][c], inverse_[r][c] -= f * inverse_[k][c];
            }
        }
        for (int r = 0; r < order; ++r)
            for (int c = 0; c < 6; ++c) {
                coefficient_[r][c] = 0.0;
                for (int k = 0; k < order; ++k) coefficient_[r][c] += inverse_[r][k] * B[k][c];
            }
        return true;
    }

    double coefficient_[order][6] = {}, inverse_[order][order] = {}, R_[9] = {};
    double variance_ = 0.0, time_ = 0.0, window_ = 1.0, bend_ = 0.0;
    bool known_ = false, cubic_ = false;
};

}  // namespace contactbench
