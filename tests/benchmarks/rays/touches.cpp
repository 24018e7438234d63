// The kernel's headers alone, as a controller in C++ uses them: touches one after the other, no Python between.
//
// A shared library for compiled.py, in S: m, N, N*m. Points are NaN where there is none.
#include <limits>
#include <memory>

#include "contactbench/solver.hpp"
#include "rows.hpp"

namespace {

contactbench::Vec3 vector(const double* v) { return {v[0], v[1], v[2]}; }

contactbench::Wrench wrench(const double* w) { return {vector(w), vector(w + 3)}; }

void put(double* to, const contactbench::Answer& a) {
    const contactbench::Candidate* c = a.contact();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    to[0] = c ? c->point.x : nan, to[1] = c ? c->point.y : nan, to[2] = c ? c->point.z : nan;
}

}  // namespace

// `gates`: min_force, cos_friction, implausible_misfit, rival_cost, ambiguity_distance, behind_cost, behind_distance,
// follow_cost, follow_distance, depth_distance.
extern "C" void* touches_new(const double* vertices, std::int64_t vertex_count, const std::int32_t* facets,
                             std::int64_t facet_count, const double* covariance, double torsion_arm, double deviation,
                             int curved, const double* gates) {
    std::vector<contactbench::Vec3> points;
    for (std::int64_t i = 0; i < vertex_count; ++i) points.push_back(vector(vertices + 3 * i));
    std::vector<contactbench::Triangle> triangles;
    for (std::int64_t i = 0; i < facet_count; ++i)
        triangles.push_back({facets[3 * i], facets[3 * i + 1], facets[3 * i + 2]});
    contactbench::WrenchCovariance noise;
    for (int i = 0; i < 36; ++i) noise.s[i / 6][i % 6] = covariance[i];
    contactbench::Gates g;
    g.min_force = gates[0], g.cos_friction = gates[1], g.implausible_misfit = gates[2], g.rival_cost = gates[3];
    g.ambiguity_distance = gates[4], g.behind_cost = gates[5], g.behind_distance = gates[6];
    g.follow_cost = gates[7], g.follow_distance = gates[8], g.depth_distance = gates[9];
    auto model = std::make_shared<const contactbench::Model>(
        contactbench::make_model(std::move(points), triangles, {}, {}, {deviation, curved != 0}));
    return new contactbench::Solver(std::move(model), noise, torsion_arm, g);
}

extern "C" void touches_drop(void* solver) { delete static_cast<contactbench::Solver*>(solver); }

extern "C" void touches_locate(void* solver, const double* wrenches, std::int64_t count, int threads, double* points) {
    const auto& s = *static_cast<const contactbench::Solver*>(solver);
    each_stretch(count, threads, [&](std::int64_t from, std::int64_t to) {
        for (std::int64_t i = from; i < to; ++i) put(points + 3 * i, s.locate(wrench(wrenches + 6 * i)));
    });
}

extern "C" void touches_track(void* solver, const double* wrenches, std::int64_t count, double* points) {
    auto& s = *static_cast<contactbench::Solver*>(solver);
    for (std::int64_t i = 0; i < count; ++i) put(points + 3 * i, s.track(wrench(wrenches + 6 * i)));
}
