// How large the torsion of a touch is, learned while one is followed.
//
// The pitch of a wrench, M . F / |F|^2, is the same for every point of the surface: less what noise makes of it, its size
// is the scale of torsion before anything is searched. The arm is wider than that, so that the pitch of a moment counts
// as the touch's own: an error of the force that explained it would move the point sideways.
//
// A second touch that grows slowly has a pitch, too, and no step that would tell it. But the force changes with it, and
// the moment says that the touch has left the place where it was a second or two ago. A touch that spins where it is, or
// slides under a steady force, does not do both. Then what was learned is forgotten.
//
// Contract: S frame, N, N*m, m, s. One stream; no allocation. By time, not by samples: the rate does not matter.
#pragma once

#include "answer.hpp"

namespace contactbench {

// What is known of torsion beforehand: one sigma of the local torque over the force, and whether a run learns it.
struct Torsion {
    Torsion(double of_touch = 1e-3, bool in_run = false) : arm(of_touch), learned(in_run) {}
    double arm;  // m
    bool learned;
};

class TorsionArm {
public:
    explicit TorsionArm(Torsion start) : start_(start) {}

    const Torsion& start() const { return start_; }
    void reset() { *this = TorsionArm(start_); }

    // No less than to begin with.
    double arm() const {
        const double first2 = start_.arm * start_.arm, mean = (prior * first2 + sum_) / (prior + weight_);
        return std::max(start_.arm, std::sqrt(std::min(std::max(mean, first2), most * most)));
    }

    // For how long, s; NaN: it is not learned.
    double since() const { return start_.learned ? since_ : std::numeric_limits<double>::quiet_NaN(); }

    // A sample of the touch that is followed, before it is located: its pitch, the variance that noise gives that, and the
    // seconds since the sample before.
    void see(const Wrench& w, double pitch, double noise2, double seconds, const Gates& g) {
        if (!(start_.learned && seconds > 0.0 && seconds < memory)) return;
        if (joined(w, pitch, g)) {
            sum_ = weight_ = since_ = 0.0;
            return;
        }
        const double left = 1.0 / (1.0 + seconds / memory);
        sum_ = left * (sum_ + seconds * (wide * std::min(pitch * pitch, most * most) - noise2));
        weight_ = left * (weight_ + seconds);
        since_ += seconds;
    }

    // Where it was located, if that was accepted.
    void note(const Wrench& w, const Candidate& c, double seconds, const Gates& g) {
        if (!start_.learned) return;
        // What begins lightly is not where it seems to be.
        const bool light = !(norm2(w.F) < 4.0 * norm2(before_.force));
        if (!light && (age_ += seconds) < memory) return;
        before_ = later_, later_ = {w.F, c.point, c.normal, detail::own_radius(c, g)}, age_ = 0.0;
        if (light) before_ = later_;
    }

    // Variance that a torsion so much larger than at the beginning gives a point along the force's slope, m^2 at a slope
    // of one: what twists the probe is an area, and friction on it acts where the area bends away.
    double patch2(double arm) const { return std::max(0.0, arm * arm - start_.arm * start_.arm) / wide; }

private:
    struct Moment {
        Vec3 force, point, normal;
        double radius = 0.0;
    };

    // Has something else begun to touch since the moment before?
    bool joined(const Wrench& w, double pitch, const Gates& g) const {
        const double size2 = norm2(before_.force), least = 2.0 * g.min_force;
        if (!(size2 > 0.0 && norm2(w.F - before_.force) >= std::max(least * least, changed * changed * size2))) return false;
        // A torsion about its normal does not move a touch from its place, but the normal is only nearly known.
        const Vec3 rest = w.M - cross(before_.point, w.F), n = before_.normal;
        const double near = moved * before_.radius * std::fabs(dot(w.F, n)) + leans * std::fabs(pitch) * norm(w.F);
        return norm(rest - dot(rest, n) * n) > near;
    }

    static constexpr double memory = 1.0, prior = 0.5;  // s
    static constexpr double most = 9e-3;                // m
    static constexpr double wide = 2.5;                 // over the mean square of the pitch
    static constexpr double changed = 0.12;             // of the force
    static constexpr double moved = 0.5;                // of the radius of what is the same touch
    static constexpr double leans = 0.25;               // of the pitch
    Torsion start_;
    double sum_ = 0.0, weight_ = 0.0, since_ = 0.0;
    Moment before_, later_;  // between one and two seconds ago, and since then
    double age_ = 0.0;
};

}  // namespace contactbench
