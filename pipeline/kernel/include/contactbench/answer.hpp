// What is said of a wrench: reason codes, the touches that explain it, and how they compare.
//
// Contract: lengths m, forces N, torques N*m. Nothing here allocates.
#pragma once

#include "gates.hpp"
#include "model.hpp"

namespace contactbench {

enum class Reason : std::uint8_t {
    ok,
    vertex,
    ambiguous,
    low_force,
    tangential,
    off_surface,
    outside_region,
    saturated,
    stale,
    not_finite,
    not_a_rotation,
    by_region,
    implausible,
    two_touches,
    unhealthy,
    uncertain,
};
inline constexpr int reason_count = 16;

// Does an answer with this reason carry a point?
inline bool has_point(Reason r) {
    return r <= Reason::ambiguous || r == Reason::by_region || r == Reason::two_touches || r == Reason::uncertain;
}

// May a controller use it?
inline bool accepted(Reason r, const Gates& g) {
    return r <= Reason::vertex || (r == Reason::by_region && g.accept_by_region);
}

// May tracking follow it? What is uncertain is there, and nowhere else: asking for nearness moves no point.
inline bool followed(Reason r, const Gates& g) { return accepted(r, g) || r == Reason::uncertain; }

inline constexpr double same_touch_sigmas = 4.5;
// Off a touch's plane, along the force, beside gates.depth_distance, per metre along it. A surface that bends away faster
// is another place.
inline constexpr double same_touch_slope = 0.5;
// A surface that lies further off than this share of gates.depth_distance is not the touch's own; and within this much d2
// two touches are as likely.
inline constexpr double layer_share = 0.3, layer_slope = 0.4, layer_cost = 4.0, same_misfit = 0.25;

// Numbers that differ by less than this are equal: what is symmetric ties, and rounding shall not decide. They are
// rounded to it rather than compared with a tolerance, so that an order stays an order.
inline constexpr double tie = 1.0 / (1 << 24);
inline double to_tie(double x) { return std::nearbyint(x / tie); }
// m: what is exactly as far as is asked, as steps are made to be, is no further.
inline constexpr double no_further = 1e-9;
inline constexpr double no_deeper = 1.0 + 1e-6;

enum class Why : std::uint8_t { chosen, misfit, region, previous, downstream };

// The best touch on a facet, and what it costs: d2 less the prior. The least cost is the likeliest touch.
struct Candidate {
    Vec3 point, normal;    // S, m; unit, outward
    double torque = 0.0;   // k, N*m: the local torque on the probe is k * normal
    double cosine = 0.0;   // of the friction angle, between -F and the normal
    double misfit = 0.0;   // d2
    double prior = 0.0;    // 2 ln(odds) of region and untouchable facets
    double follow = 0.0;   // of the last contact
    double behind = 0.0;   // cost of lying behind another candidate
    double across = 0.0;   // largest standard deviation of the point, seen along the force, m
    double depth = 0.0;    // standard deviation along the force, for another surface may be the one that is touched, m
    Vec3 slope;            // f + cosine * normal: the force along the facet, over |F|
    std::int32_t face = -1, vertex = -1, region = 0;
    std::int32_t slot = -1;
    Why why = Why::misfit;

    double cost_without_prior() const { return misfit - follow + behind; }
    double cost_unhidden() const { return misfit - follow - prior; }
    double cost() const { return cost_without_prior() - prior; }
};

struct Answer {
    static constexpr int capacity = 8;
    Reason reason = Reason::off_surface;
    std::int32_t chosen = -1;  // index into candidates, -1 when no point is given
    std::int32_t count = 0;
    Candidate candidates[capacity];  // each at a place of its own; least cost_unhidden() first
    double misfit = std::numeric_limits<double>::quiet_NaN();  // of the best touch, chosen or not
    double arm = std::numeric_limits<double>::quiet_NaN();     // m: pitch, M . F / |F|^2
    double left_over = std::numeric_limits<double>::quiet_NaN();  // N*m that the best touch does not explain
    double torsion_arm = std::numeric_limits<double>::quiet_NaN();    // m: judged by; 1 sigma of k over |F|
    double torsion_since = std::numeric_limits<double>::quiet_NaN();  // s: learned for so long; NaN: declared
    double confidence = 0.0;  // 1 / (1 + the odds of every other place): no probability, see decide()
    bool has_second = false;
    Candidate second;  // a touch that joined the one that is followed

    void clear() {
        chosen = -1, count = 0;
        misfit = arm = left_over = torsion_arm = torsion_since = std::numeric_limits<double>::quiet_NaN();
        confidence = 0.0;
        has_second = false;
    }
    const Candidate* contact() const { return chosen < 0 ? nullptr : &candidates[chosen]; }
};

// The likeliest of the others, or null.
inline const Candidate* runner_up(const Answer& a) {
    const Candidate* best = nullptr;
    for (int i = 0; i < a.count; ++i)
        if (i != a.chosen && (!best || to_tie(a.candidates[i].cost()) < to_tie(best->cost()))) best = &a.candidates[i];
    return best;
}

// Why a sample is not worth searching, or ok.
inline Reason gate(const Wrench& w, const Gates& g) {
    if (!finite(w.F) || !finite(w.M)) return Reason::not_finite;
    const double v[6] = {w.F.x, w.F.y, w.F.z, w.M.x, w.M.y, w.M.z};
    for (int i = 0; i < 6; ++i)
        if (std::fabs(v[i]) >= g.saturation[i]) return Reason::saturated;
    const double force = norm(w.F);
    // Squares of forces beyond 1e150 N overflow; such a number is no measurement either.
    if (!std::isfinite(force) || !std::isfinite(norm(w.M))) return Reason::saturated;
    return force > 0.0 && force >= g.min_force ? Reason::ok : Reason::low_force;
}

namespace detail {

// How far p is from a touch. Down its slope less counts: noise that moves w by 1 moves the point by 1 / cosine there,
// and there alone, so a ball of its largest standard deviation would swallow true rivals of a steep touch.
inline double apart(const Candidate& touch, Vec3 p) {
    const Vec3 d = p - touch.point;
    const double down = dot(d, touch.slope);
    return std::sqrt(std::max(0.0, norm2(d) - down * down));
}

// Within this it is the same touch.
inline double own_radius(const Candidate& c, const Gates& g) {
    return std::max(g.ambiguity_distance, same_touch_sigmas * c.across) + no_further;
}

// Where p lies off a touch's plane, against the force, and how far it is along the plane; m. On a steep plane noise leads
// further, and a curved surface bends away further: both are over the cosine.
struct Off {
    double height, along;
};

inline Off off_plane(const Candidate& touch, Vec3 p) {
    const Vec3 d = p - touch.point;
    const double off = dot(d, touch.normal), steep = 1.0 / touch.cosine;
    return {steep * off, steep * std::sqrt(std::max(0.0, norm2(d) - off * off))};
}

// Is p another place than a touch? Noise moves the point across the force, and along it only as far as the touch's own
// surface leads: what lies deeper or higher than that is another surface, however near it is across.
// `depth`: of the gates, 0: only what is across counts.
inline bool elsewhere(const Candidate& touch, double radius, double depth, Vec3 p) {
    if (apart(touch, p) > radius) return true;
    if (!(depth > 0.0)) return false;
    const Off off = off_plane(touch, p);
    return std::fabs(off.height) > no_deeper * depth + same_touch_slope * off.along;
}

// Does the line of force, along f, meet `front` first? Only a touch that is about as likely may stand in the way.
inline bool hides(const Candidate& front, const Candidate& back, const Gates& g, Vec3 f) {
    return dot(back.point - front.point, f) > g.behind_distance + no_further &&
           front.cost_unhidden() <= back.cost_unhidden() + g.behind_cost;
}

inline Why lost_by(const Candidate& winner, const Candidate& loser, const Gates& g) {
    const double delta = loser.cost() - winner.cost();
    if (loser.prior < winner.prior && delta - (winner.prior - loser.prior) <= g.rival_cost) return Why::region;
    if (loser.follow < winner.follow && delta - (winner.follow - loser.follow) <= g.rival_cost) return Why::previous;
    return loser.behind > winner.behind && delta <= g.rival_cost ? Why::downstream : Why::misfit;
}

}  // namespace detail

// Ranks the candidates, of which there are some, and says what they are worth together. Returns the likeliest, chosen
// or not.
inline int decide(Answer& a, const Gates& g, Vec3 f) {
    for (int i = 0; i < a.count; ++i)
        for (int j = 0; j < a.count; ++j)
            if (detail::hides(a.candidates[j], a.candidates[i], g, f)) a.candidates[i].behind = g.behind_cost;
    int best = 0;
    for (int i = 1; i < a.count; ++i)
        if (to_tie(a.candidates[i].cost()) < to_tie(a.candidates[best].cost())) best = i;
    a.chosen = best;
    Candidate& winner = a.candidates[best];
    a.misfit = winner.misfit;
    a.reason = winner.vertex >= 0 ? Reason::vertex : Reason::ok;
    double others = 0.0;
    bool without = false;  // would another place do as well, had nobody said where touches are?
    for (int i = 0; i < a.count; ++i) {
        Candidate& c = a.candidates[i];
        if (i == best) continue;
        c.why = detail::lost_by(winner, c, g);
        const double delta = c.cost() - winner.cost();
        others += std::exp(-0.5 * delta);
        if (delta <= g.rival_cost) a.reason = Reason::ambiguous;
        without |= c.cost_without_prior() - winner.cost_without_prior() <= g.rival_cost;
    }
    winner.why = Why::chosen;
    a.confidence = 1.0 / (1.0 + others);
    if (a.reason != Reason::ambiguous && without) a.reason = Reason::by_region;
    if (g.region_only && (winner.region == 0 || winner.prior < 0.0)) {
        winner.why = Why::region;
        a.chosen = -1;
        a.reason = Reason::outside_region;
        a.confidence = 0.0;
    }
    return best;
}

}  // namespace contactbench
