// Made from pipeline/gates.py by packaging/declarations.py: change that, not this.
#pragma once

#include <cmath>
#include <cstdint>

namespace contactbench {

// SI; a cost is 2 ln(odds).
struct Gates {
    // Reason low_force below this force.
    double min_force = 0.5;
    // Reason tangential beyond this angle to the normal.
    double cos_friction = 0.25881904510252074;
    // Reason ambiguous when another likely place is this far away, or 4.5 standard deviations if that is more.
    double ambiguity_distance = 0.005;
    // Reason implausible if a touch leaves a misfit that chance alone reaches with at most this probability.
    double implausible_misfit = 10.827566170662935;
    // Reason ambiguous unless the likeliest place is this many times likelier than any other.
    double rival_cost = 9.210340371976184;
    // Odds that the first surface on the line of force is touched rather than one behind it.
    double behind_cost = 4.0;
    // When tracking: odds that a touch stays near the previous one rather than jumps.
    double follow_cost = 13.815510557964274;
    // When tracking: prefer places this near the last contact.
    double follow_distance = 0.01;
    // When tracking: forget the last contact after this many samples in a row without an accepted one.
    std::int64_t recent_samples = 20;
    // Reason stale when a sample is older; when tracking, a longer gap starts anew.
    double max_age = 0.1;
    // Reason saturated when a channel reaches this.
    double saturation[6] = {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
    // Refuse contacts outside every region of the mesh.
    bool region_only = false;
    // Accept, and follow when tracking, contacts whose place is certain only because of the regions of the mesh.
    bool accept_by_region = true;
    // Reason uncertain when the largest standard deviation of the point is more than this. 0: not asked.
    double sigma_max = 0.0;
    // Two places, too, where one lies this far off the other's plane along the force, and half of what it is away
    // in that plane. 0: not asked.
    double depth_distance = 0.0;
    // Nearer surfaces, m along the force, are one.
    double behind_distance = 0.003;
};

// How a gate follows from what a bundle holds.
enum class From { value, odds, angle };

// Calls visit(name in a bundle, name here, member, From) for each gate.
template <class Visit>
void each_gate(Gates& g, Visit&& visit) {
    visit("min_force_N", "min_force", g.min_force, From::value);
    visit("friction_angle_rad", "cos_friction", g.cos_friction, From::angle);
    visit("ambiguity_distance_m", "ambiguity_distance", g.ambiguity_distance, From::value);
    visit("implausible_misfit", "implausible_misfit", g.implausible_misfit, From::value);
    visit("rival_odds", "rival_cost", g.rival_cost, From::odds);
    visit("first_odds", "behind_cost", g.behind_cost, From::odds);
    visit("follow_odds", "follow_cost", g.follow_cost, From::odds);
    visit("follow_distance_m", "follow_distance", g.follow_distance, From::value);
    visit("recent_samples", "recent_samples", g.recent_samples, From::value);
    visit("max_age_s", "max_age", g.max_age, From::value);
    visit("saturation", "saturation", g.saturation, From::value);
    visit("region_only", "region_only", g.region_only, From::value);
    visit("accept_by_region", "accept_by_region", g.accept_by_region, From::value);
    visit("sigma_max_m", "sigma_max", g.sigma_max, From::value);
    visit("depth_distance_m", "depth_distance", g.depth_distance, From::value);
}

}  // namespace contactbench
