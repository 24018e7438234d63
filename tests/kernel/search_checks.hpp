// Pruned search, table scan and exhaustive scan must name the same facets and vertices.
#pragma once

#include <set>
#include <stdexcept>

#include "contactbench/scan.hpp"
#include "meshes.hpp"

namespace testing {

using contactbench::Hits;
using contactbench::Model;
using contactbench::Query;

// Friction angles closer to 90 degrees than this are rounding, and so is the side they lie on.
inline constexpr double grazing = 1e-9;

using Keys = std::multiset<std::pair<std::int32_t, std::int32_t>>;

inline Keys keys_of(const Hits& hits, double least_cosine = grazing) {
    Keys keys;
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (hits[i].cosine >= least_cosine) keys.insert({hits[i].face, hits[i].vertex});
    return keys;
}

// A touch that is likely to find trouble: on corners, on edges, edge-on, along the axes.
inline Touch nasty_touch(const Mesh& mesh, const Model& m, Random& random, double pitch) {
    Touch touch = random_touch(m, random, random.below(3) ? 1.5 : 1.5707963267948966, pitch);
    const Triangle& t = mesh.faces[random.below(mesh.faces.size())];
    const Vec3 a = mesh.vertices[std::size_t(t[0])], b = mesh.vertices[std::size_t(t[1])];
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    switch (random.below(7)) {
        case 0: touch.point = a; break;
        case 1: touch.point = 0.5 * (a + b); break;
        case 2: touch.point = a + random.unit() * (b - a); break;
        case 3: touch.force = (10.0 / norm(b - a)) * (b - a); break;
        case 4: touch.force = (random.below(2) ? 5.0 : -5.0) * axes[random.below(3)]; break;
        case 5: touch.point = touch.point + m.frame.scale * random.normal3(); break;
        default: break;
    }
    return touch;
}

inline void check_same_candidates(const Mesh& mesh, int rounds, std::uint64_t seed) {
    Random random(seed);
    const Model m = model_of(mesh);
    const contactbench::ScanTable table(m);
    for (const double pitch : {0.0, 1e-15, 1e-12, 1e-8, 1e-4, 0.01, 0.1, 1.0, 30.0, 900.0, 5000.0})
        for (const double cap : {0.0, 1e-3, 0.26})
            for (int i = 0; i < rounds; ++i) {
                const Wrench w = nasty_touch(mesh, m, random, pitch).wrench();
                const Query q = contactbench::make_query(m.frame, w);
                Hits every, pruned, table_hits;
                contactbench::exhaust(m, q, cap, every);
                contactbench::search(m, q, cap, pruned);
                contactbench::scan(table, m, q, cap, table_hits);
                CHECK(keys_of(every) == keys_of(pruned));
                CHECK(keys_of(every, 0.0) == keys_of(table_hits, 0.0));
            }
}

// A line that enters a closed convex mesh is always answered, and, away from ties, once.
inline void check_convex_is_complete() {
    Random random(21);
    for (const Mesh& mesh : {sphere(4), ellipsoid(3), octahedron(), box()}) {
        const Model m = model_of(mesh);
        CHECK(m.convex);
        for (const double pitch : {0.0, 1e-9, 1e-3, 0.1, 1.0, 10.0})
            for (int i = 0; i < 1500; ++i) {
                const Touch touch = random_touch(m, random, 1.4, pitch);
                Hits hits;
                contactbench::search(m, contactbench::make_query(m.frame, touch.wrench()), 0.0, hits);
                CHECK(keys_of(hits).size() == 1);
                // Without a local torque the answer is the touch itself.
                if (pitch == 0.0 && hits.size() > 0) CHECK(norm(hits[0].point - touch.point) < 1e-9 * m.frame.scale);
            }
    }
    for (const Mesh& mesh : {t_shape(3), torus(20, 10), single(), open_shell(2), two_pieces(2)}) CHECK(!model_of(mesh).convex);
}

// Size and place of a mesh must not matter: 1 um to 1 km, and up to 1 m (10^4 mesh sizes) off the sensor.
inline void check_sizes() {
    const Mesh base = t_shape(3);
    for (const double scale : {1.0, 2e-5, 2e4})
        for (const double offset : {0.0, 15.0, 1e4}) {
            const Mesh mesh = moved(base, "scaled", false,
                                    [=](Vec3 p) { return scale * (p + Vec3{offset * 0.06, -offset * 0.03, 0.0}); });
            check_same_candidates(mesh, 20, 31);
            const Model m = model_of(mesh);
            Random random(32);
            for (int i = 0; i < 500; ++i) {
                const Touch touch = random_touch(m, random, 1.0, 0.0);
                Hits hits;
                contactbench::search(m, contactbench::make_query(m.frame, touch.wrench()), 0.0, hits);
                double nearest = HUGE_VAL;
                for (std::size_t h = 0; h < hits.size(); ++h)
                    nearest = std::fmin(nearest, norm(hits[h].point - touch.point));
                CHECK(nearest <= 1e-7 * m.frame.scale);
            }
        }
}

inline void check_far_moment() {
    const Mesh mesh = sphere(3);
    const Model m = model_of(mesh);
    Random random(41);
    for (int i = 0; i < 300; ++i) {
        Touch touch = random_touch(m, random, 1.0, 0.0);
        touch.torque = (i % 2 ? 1.5 : 0.5) * contactbench::far_moment * norm(touch.force) * m.frame.scale;
        const Query q = contactbench::make_query(m.frame, touch.wrench());
        CHECK(contactbench::prunable(q) == (i % 2 == 0));
        Hits every, pruned;
        contactbench::exhaust(m, q, 0.0, every);
        contactbench::search(m, q, 0.0, pruned);
        CHECK(every.size() > 0 && keys_of(every) == keys_of(pruned));
    }
}

template <class Make>
bool refuses(Make&& make) {
    try {
        make();
    } catch (const std::invalid_argument&) {
        return true;
    }
    return false;
}

inline void check_refusals() {
    const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    const auto make = [&](std::vector<Vec3> v, std::vector<Triangle> f, std::vector<std::int32_t> r = {}) {
        return refuses([&] { (void)contactbench::make_model(std::move(v), f, std::move(r)); });
    };
    CHECK(!make(corners, {{0, 1, 2}}));
    CHECK(make(corners, {}));
    CHECK(make({}, {{0, 1, 2}}));
    CHECK(make(corners, {{0, 1, 4}}));
    CHECK(make(corners, {{0, 1, -1}}));
    CHECK(make(corners, {{0, 1, 1}}));
    CHECK(make(corners, {{0, 1, 3}}));
    CHECK(make(corners, {{0, 1, 2}}, {1, 2}));
    CHECK(make({{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
    CHECK(make({{0, 0, 0}, {HUGE_VAL, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
    CHECK(make({{-1.7e308, 0, 0}, {1.7e308, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
}

inline void check_search() {
    std::uint64_t seed = 100;
    for (const Mesh& mesh : zoo()) check_same_candidates(mesh, 40, ++seed);
    check_same_candidates(sphere(6), 2, 200);  // four levels of nodes
    check_convex_is_complete();
    check_sizes();
    check_far_moment();
    check_refusals();
}

}  // namespace testing
