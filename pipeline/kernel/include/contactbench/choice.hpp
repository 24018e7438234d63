// Gates, reason codes, and which of several candidates is the contact.
//
// In order: within the friction cone; in the operator's priority region; near the previous accepted
// contact when one is recent; smallest |k|, which for one wrench is the smallest friction angle; among
// equals (parallel faces: a head and the flange behind it), the one that the force meets first. When
// the last rule had to decide between points further apart than the tolerance, and not by a clear
// ratio of |k|, the answer says so.
//
// Contract: lengths m, forces N, torques N*m. O(candidates), no allocation.
#pragma once

#include "candidate.hpp"

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
};

// Does an answer with this reason carry a point?
inline bool has_point(Reason r) { return r <= Reason::ambiguous; }
// Is it one that a controller may use and that tracking may follow?
inline bool accepted(Reason r) { return r <= Reason::vertex; }

struct Gates {
    double min_force = 0.5;                // N
    double cos_friction = 0.25881904510252074;  // of 75 degrees
    double ambiguity_distance = 0.005;     // m
    double torque_ratio = 1.5;
    double rival_sigmas = 3.0;
    double follow_distance = 0.010;        // m
    std::int64_t recent_samples = 20;
    double max_age = 0.1;                  // s
    double saturation[6] = {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
    bool region_only = false;
};

struct Answer {
    Reason reason = Reason::off_surface;
    std::int32_t chosen = -1;  // index into hits, -1 when no point is given
    Hits hits;
};

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

// Regions are numbered from 1 by priority; no region comes last.
inline std::int32_t region_rank(const Candidate& c) {
    return c.region > 0 ? c.region : std::numeric_limits<std::int32_t>::max();
}

namespace detail {

struct Rank {
    std::int32_t region;
    double distance;  // to the previous contact; one value for all when there is none near
    double torque;
    std::int32_t face, vertex;  // last resort: coinciding candidates
};

inline Rank rank(const Candidate& c, const Gates& g, const Vec3* previous) {
    const double d = previous ? norm(c.point - *previous) : HUGE_VAL;
    return {region_rank(c),
            d <= g.follow_distance ? d : HUGE_VAL, std::fabs(c.torque), c.face, c.vertex};
}

inline bool before(const Rank& a, const Rank& b) {
    if (a.region != b.region) return a.region < b.region;
    if (a.distance != b.distance) return a.distance < b.distance;
    if (a.torque != b.torque) return a.torque < b.torque;
    return a.face != b.face ? a.face < b.face : a.vertex < b.vertex;
}

// What told the loser from the winner.
inline Why lost_by(const Rank& winner, const Rank& loser) {
    if (winner.region != loser.region) return Why::region;
    // Both near the previous contact is no clear verdict: only a loser that is far from it is out.
    return winner.distance < HUGE_VAL && loser.distance == HUGE_VAL ? Why::previous : Why::torque;
}

}  // namespace detail

// Torques this close are equal: rounding, or a degree of tilt, must not choose between parallel faces.
inline constexpr double equal_torque = 1.01;

// Of the candidates that `best` beat by torque alone and by next to nothing, the one furthest upstream.
inline std::size_t furthest_upstream(const Answer& a, const Gates& g, Vec3 force, const Vec3* previous,
                                     std::size_t best) {
    const detail::Rank top = detail::rank(a.hits[best], g, previous);
    std::size_t first = best;
    for (std::size_t i = 0; i < a.hits.size(); ++i) {
        if (a.hits[i].cosine < g.cos_friction) continue;
        const detail::Rank r = detail::rank(a.hits[i], g, previous);
        if (r.region != top.region || r.distance != top.distance || r.torque > equal_torque * top.torque) continue;
        const double ahead = dot(a.hits[first].point - a.hits[i].point, force);
        if (ahead > 0.0 || (ahead == 0.0 && a.hits[i].face < a.hits[first].face)) first = i;
    }
    return first;
}

// Fills in chosen, reason and every candidate's `why`. `previous`: last accepted contact, or null.
inline void choose(Answer& a, const Gates& g, Vec3 force, const Vec3* previous) {
    a.chosen = -1;
    a.reason = a.hits.size() == 0 ? Reason::off_surface : Reason::tangential;
    detail::Rank best{};
    for (std::size_t i = 0; i < a.hits.size(); ++i) {
        Candidate& c = a.hits[i];
        c.why = Why::friction;
        if (c.cosine < g.cos_friction) continue;
        const detail::Rank r = detail::rank(c, g, previous);
        if (a.chosen < 0 || detail::before(r, best)) best = r, a.chosen = std::int32_t(i);
    }
    if (a.chosen < 0) return;
    if (a.hits.size() > 1) {
        a.chosen = std::int32_t(furthest_upstream(a, g, force, previous, std::size_t(a.chosen)));
        best = detail::rank(a.hits[std::size_t(a.chosen)], g, previous);
    }
    Candidate& winner = a.hits[std::size_t(a.chosen)];
    a.reason = winner.vertex >= 0 ? Reason::vertex : Reason::ok;
    for (std::size_t i = 0; i < a.hits.size(); ++i) {
        Candidate& c = a.hits[i];
        if (c.cosine < g.cos_friction) continue;
        const detail::Rank r = detail::rank(c, g, previous);
        c.why = detail::lost_by(best, r);
        const bool close_call = c.why == Why::torque && r.torque <= g.torque_ratio * best.torque;
        if (close_call && norm(c.point - winner.point) > g.ambiguity_distance) a.reason = Reason::ambiguous;
        if (c.why == Why::torque && r.torque <= equal_torque * best.torque) c.why = Why::downstream;
    }
    winner.why = Why::chosen;
    if (g.region_only && winner.region == 0) {
        winner.why = Why::region;
        a.chosen = -1;
        a.reason = Reason::outside_region;
    }
}

}  // namespace contactbench
