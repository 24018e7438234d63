// The solver as a whole: streams, gates, memory, and the methods it is compared with.
#pragma once

#include <cstring>

#include "contactbench/algorithm1.hpp"
#include "contactbench/linearity.hpp"
#include "contactbench/paraboloid.hpp"
#include "search_checks.hpp"

namespace testing {

using contactbench::Answer;
using contactbench::Candidate;
using contactbench::Gates;
using contactbench::Reason;
using contactbench::Solver;
using contactbench::WrenchCovariance;

// Counts every allocation of the program; defined in test_kernel.cpp.
long allocations();

inline WrenchCovariance noise_of(double times = 1.0) {
    WrenchCovariance noise;
    for (int i = 0; i < 6; ++i) noise.s[i][i] = times * times * (i < 3 ? 0.0025 : 4e-6);
    return noise;
}

inline Solver solver_of(const Mesh& mesh, const Gates& gates = {}, double noise = 1.0,
                        std::vector<std::int32_t> region = {}) {
    return Solver(std::make_shared<const Model>(model_of(mesh, std::move(region))), noise_of(noise), gates);
}

inline bool same_bits(Vec3 a, Vec3 b) { return std::memcmp(&a, &b, sizeof a) == 0; }

inline bool same_candidate(const Candidate& a, const Candidate& b) {
    return same_bits(a.point, b.point) && same_bits(a.normal, b.normal) && a.torque == b.torque &&
           a.cosine == b.cosine && a.face == b.face && a.vertex == b.vertex && a.region == b.region && a.why == b.why;
}

// The same answer to the bit; candidates may come in another order.
inline bool same_answer(const Answer& a, const Answer& b) {
    if (a.reason != b.reason || a.hits.size() != b.hits.size() || (a.chosen < 0) != (b.chosen < 0)) return false;
    if (a.chosen >= 0 && !same_candidate(a.hits[std::size_t(a.chosen)], b.hits[std::size_t(b.chosen)])) return false;
    const auto sorted = [](const Answer& answer) {
        std::vector<Candidate> all;
        for (std::size_t i = 0; i < answer.hits.size(); ++i) all.push_back(answer.hits[i]);
        std::sort(all.begin(), all.end(), [](const Candidate& p, const Candidate& q) {
            return p.face != q.face ? p.face < q.face : p.vertex < q.vertex;
        });
        return all;
    };
    const auto p = sorted(a), q = sorted(b);
    return std::equal(p.begin(), p.end(), q.begin(), same_candidate);
}

// A contact that wanders, jumps and lifts off, with samples that are late or broken.
struct Stream {
    Touch touch;
    double age = 0.0;

    Wrench next(const Model& m, Random& random, double noise) {
        const auto event = random.below(400);
        // A large pitch now and then: there a cut is bounded by its cones of normals, not by the capsule.
        if (event < 2) touch = random_touch(m, random, 1.2, event == 0 ? 0.1 : 1.0);
        if (event == 2) touch.force = 1e-3 * touch.force;
        if (event >= 3 && event < 6) touch.force = (10.0 / norm(touch.force)) * touch.force;
        touch.point = touch.point + (0.003 * m.frame.scale) * random.normal3();
        touch.force = touch.force + (0.01 * norm(touch.force)) * random.normal3();
        Wrench w = touch.wrench();
        w.F = w.F + 0.05 * noise * random.normal3();
        w.M = w.M + 0.002 * noise * random.normal3();
        if (event == 6) w.M.y = NAN;
        age = event == 7 || event == 8 ? 1.0 : 0.0;
        return w;
    }
};

// track() is locate() with the last accepted contact, as long as that is recent.
inline void check_tracking() {
    Random random(51);
    for (const Mesh& mesh : zoo())
        for (const double noise : {0.0, 1.0, 30.0}) {
            std::vector<std::int32_t> region(mesh.faces.size());
            for (std::int32_t& r : region) r = std::int32_t(random.below(3));
            Gates gates;
            gates.recent_samples = 5;
            Solver solver = solver_of(mesh, gates, noise, region);
            Stream stream{random_touch(solver.model(), random, 1.0, 0.05)};
            Vec3 last;
            std::int64_t misses = gates.recent_samples + 1;
            for (int i = 0; i < 3000; ++i) {
                const Wrench w = stream.next(solver.model(), random, noise);
                const Vec3* previous = misses <= gates.recent_samples ? &last : nullptr;
                CHECK((solver.previous() == nullptr) == (previous == nullptr));
                Answer want;
                want.reason = Reason::stale;
                if (stream.age == 0.0) want = solver.locate(w, previous);
                const Answer got = solver.track(w, stream.age);
                CHECK(same_answer(want, got));
                if (i % 16 == 0 && stream.age == 0.0) CHECK(same_answer(want, solver.locate_exhaustively(w, previous)));
                ++misses;
                if (contactbench::accepted(got.reason)) last = got.hits[std::size_t(got.chosen)].point, misses = 0;
            }
            solver.reset();
            CHECK(solver.previous() == nullptr);
        }
}

inline void check_gates() {
    Gates gates;
    gates.saturation[2] = 50.0;
    Solver solver = solver_of(sphere(3), gates);
    const Wrench good{{0, 0, -5}, {0, 0, 0}};
    const auto reason = [&](Wrench w, double age = 0.0) {
        const Answer a = solver.track(w, age);
        CHECK(contactbench::has_point(a.reason) == (a.chosen >= 0));
        return a.reason;
    };
    CHECK(contactbench::accepted(reason(good)));
    for (const double bad : {double(NAN), HUGE_VAL, -HUGE_VAL}) {
        CHECK(reason({{bad, 0, -5}, {0, 0, 0}}) == Reason::not_finite);
        CHECK(reason({{0, 0, -5}, {0, bad, 0}}) == Reason::not_finite);
    }
    CHECK(reason({{0, 0, 0}, {0, 0, 0}}) == Reason::low_force);
    CHECK(reason({{0, 0, -0.49}, {0, 0, 0}}) == Reason::low_force);
    CHECK(reason({{0, 0, -50}, {0, 0, 0}}) == Reason::saturated);
    CHECK(reason({{0, 0, 50}, {0, 0, 0}}) == Reason::saturated);
    CHECK(reason({{1e200, 0, 0}, {0, 0, 0}}) == Reason::saturated);
    CHECK(reason(good, 0.2) == Reason::stale);
    CHECK(reason(good, NAN) == Reason::stale);
    CHECK(contactbench::accepted(reason(good, 0.1)));

    gates = {};
    gates.min_force = 0.0;
    CHECK(solver_of(sphere(2), gates).locate({}).reason == Reason::low_force);
    gates.region_only = true;
    CHECK(solver_of(sphere(2), gates).locate(good).reason == Reason::outside_region);
    // However long a contact may be remembered, there is none before the first.
    gates.recent_samples = std::numeric_limits<std::int64_t>::max();
    CHECK(solver_of(sphere(2), gates).previous() == nullptr);
    // Friction beyond the cone, and an axis that passes far from the probe.
    solver = solver_of(sphere(4));
    const Vec3 top{0, 0, 0.03}, steep{9.9, 0, -1.2};
    CHECK(solver.locate({steep, cross(top, steep)}).reason == Reason::tangential);
    Random random(61);
    for (int i = 0; i < 500; ++i) {
        Vec3 force = 10.0 * random.direction(), away = cross(force, random.direction());
        away = (0.12 / norm(away)) * away;
        CHECK(solver.locate({force, cross(away, force) + 0.002 * random.normal3()}).reason == Reason::off_surface);
    }
}

// Vertices that no facet uses belong to no surface: they change no answer.
inline void check_unused_vertices() {
    Mesh mesh = t_shape(3);
    const Solver plain = solver_of(mesh);
    mesh.vertices.push_back({0, 0, 100.0});
    const Solver near = solver_of(mesh);
    mesh.vertices.push_back({1e200, 0, 0});
    const Solver far = solver_of(mesh);
    Random random(62);
    for (int i = 0; i < 3000; ++i) {
        const Wrench w = random_touch(plain.model(), random, 0.6, 0.01).wrench();
        const Answer want = plain.locate(w);
        CHECK(same_answer(want, near.locate(w)) && same_answer(want, far.locate(w)));
    }
}

inline void check_memory() {
    Random random(71);
    for (const Mesh& mesh : {sphere(4), t_shape(4), torus(40, 20)}) {
        Solver solver = solver_of(mesh);
        Stream stream{random_touch(solver.model(), random, 1.0, 0.02)};
        long few = 0;
        for (int i = 0; i < 5000; ++i) {
            const Wrench w = stream.next(solver.model(), random, 1.0);
            const long before = allocations();
            const Answer a = solver.locate(w), b = solver.track(w);
            const long after = allocations();
            if (a.hits.size() > Hits::inline_count || b.hits.size() > Hits::inline_count) continue;
            ++few;
            CHECK(after == before);
        }
        CHECK(few > 1000);
    }
}

inline void check_linearity() {
    const Solver solver = solver_of(ellipsoid(4));
    Random random(72);
    int linear = 0;
    for (int i = 0; i < 200; ++i) {
        const Touch touch = random_touch(solver.model(), random, 0.1, 0.0);
        const Wrench w{(20.0 / norm(touch.force)) * touch.force,
                       (20.0 / norm(touch.force)) * touch.wrench().M};
        const Answer a = solver.locate(w);
        if (contactbench::accepted(a.reason)) linear += contactbench::is_linear(solver, w, a.hits[std::size_t(a.chosen)]);
    }
    CHECK(linear > 20);
    const Solver loud = solver_of(ellipsoid(4), {}, 100.0);
    const Wrench w{{0, 0, -10}, {0, 0, 0}};
    Candidate c;
    c.point = {0, 0, 0.16}, c.normal = {0, 0, 1};
    CHECK(!contactbench::is_linear(loud, w, c));
}

// The paper's loop finds one of the complete set, and one in the first region that has any.
inline void check_plane_loop() {
    Random random(81);
    for (const Mesh& mesh : {sphere(2), t_shape(3), torus(24, 12)}) {
        std::vector<std::int32_t> region(mesh.faces.size());
        for (std::int32_t& r : region) r = std::int32_t(random.below(3));
        const Model m = model_of(mesh, region);
        const contactbench::PlaneLoop loop(m);
        const auto order = [](std::int32_t r) { return r > 0 ? r : 3; };
        for (int i = 0; i < 2000; ++i) {
            const Wrench w = random_touch(m, random, 1.3, 0.02).wrench();
            Hits hits;
            contactbench::exhaust(m, contactbench::make_query(m.frame, w), 0.0, hits);
            Candidate found;
            const bool any = loop.locate(w, found);
            int facets = 0, first = 3, matches = 0;
            for (std::size_t h = 0; h < hits.size(); ++h) {
                if (hits[h].vertex >= 0) continue;
                ++facets;
                first = std::min(first, int(order(hits[h].region)));
                matches += any && hits[h].face == found.face && norm(hits[h].point - found.point) < 1e-9 &&
                           close(hits[h].torque, found.torque, 1e-6, 1e-9);
            }
            CHECK(any == (facets > 0));
            if (any) CHECK(matches == 1 && order(found.region) == first);
        }
    }
}

inline void check_paraboloid() {
    Random random(91);
    for (int i = 0; i < 5000; ++i) {
        contactbench::Paraboloid s;
        s.axis[2] = random.direction();
        s.axis[0] = cross(s.axis[2], random.direction());
        s.axis[0] = (1.0 / norm(s.axis[0])) * s.axis[0];
        s.axis[1] = cross(s.axis[2], s.axis[0]);
        s.origin = 0.1 * random.normal3();
        const double fitted[6] = {0.001 * random.normal(), 0.05 * random.normal(), 0.05 * random.normal(),
                                  -random.uniform(2.0, 15.0), random.normal(), -random.uniform(2.0, 15.0)};
        std::copy(fitted, fitted + 6, s.c);
        const double x = random.uniform(-0.02, 0.02), y = random.uniform(-0.02, 0.02);
        const double* c = s.c;
        const double z = c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y;
        const Vec3 slope = -(c[1] + 2 * c[3] * x + c[4] * y) * s.axis[0] - (c[2] + c[4] * x + 2 * c[5] * y) * s.axis[1];
        Touch touch;
        touch.point = s.origin + (x * s.axis[0] + y * s.axis[1] + z * s.axis[2]);
        touch.normal = (1.0 / norm(slope + s.axis[2])) * (slope + s.axis[2]);
        Vec3 side = cross(touch.normal, random.direction());
        side = (1.0 / norm(side)) * side;
        const double angle = random.uniform(0.0, 0.6);
        touch.force = random.uniform(1.0, 20.0) * (-std::cos(angle) * touch.normal + std::sin(angle) * side);
        touch.torque = 1e-3 * random.normal();
        Candidate found;
        if (!CHECK(contactbench::locate_iteratively(s, touch.wrench(), found))) continue;
        CHECK(norm(found.point - touch.point) < 1e-8);
        CHECK(norm(found.normal - touch.normal) < 1e-6);
        CHECK(std::fabs(found.torque - touch.torque) < 1e-7);
        CHECK(!contactbench::locate_iteratively(s, {-touch.force, -touch.wrench().M}, found));
    }
}

inline void check_solver() {
    check_tracking();
    check_gates();
    check_unused_vertices();
    check_memory();
    check_linearity();
    check_plane_loop();
    check_paraboloid();
}

}  // namespace testing
