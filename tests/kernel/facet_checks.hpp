// One facet at a time: the linear test, its weights, its ties and its derivative.
#pragma once

#include <algorithm>

#include "contactbench/covariance.hpp"
#include "contactbench/search.hpp"
#include "meshes.hpp"

namespace testing {

using contactbench::Candidate;
using contactbench::Hits;
using contactbench::Model;
using contactbench::Query;

// The 4x4 system of Eq. 6 by Gauss-Jordan elimination with full row pivoting: x, y, z, k.
inline bool solve_directly(const Wrench& w, Vec3 n, Vec3 on_plane, double x[4]) {
    double a[4][5] = {{0, w.F.z, -w.F.y, n.x, w.M.x},
                      {-w.F.z, 0, w.F.x, n.y, w.M.y},
                      {w.F.y, -w.F.x, 0, n.z, w.M.z},
                      {n.x, n.y, n.z, 0, dot(n, on_plane)}};
    for (int c = 0; c < 4; ++c) {
        int pivot = c;
        for (int r = c; r < 4; ++r)
            if (std::fabs(a[r][c]) > std::fabs(a[pivot][c])) pivot = r;
        if (a[pivot][c] == 0.0) return false;
        std::swap_ranges(a[c], a[c] + 5, a[pivot]);
        for (int r = 0; r < 4; ++r) {
            const double factor = r == c ? 0.0 : a[r][c] / a[c][c];
            for (int i = c; i < 5; ++i) a[r][i] -= factor * a[c][i];
        }
    }
    for (int r = 0; r < 4; ++r) x[r] = a[r][4] / a[r][r];
    return true;
}

// Random triangles, a quarter of them in a plane through the sensor origin: against the 4x4 solve.
inline void check_against_direct_solve() {
    Random random(1);
    for (int i = 0; i < 20000; ++i) {
        Mesh mesh{"random", {random.normal3(), random.normal3(), random.normal3()}, {{0, 1, 2}}, 0, false};
        if (random.below(4) == 0) mesh.vertices[2] = random.normal() * mesh.vertices[0] + random.normal() * mesh.vertices[1];
        const Model m = model_of(mesh);
        const Vec3 normal = m.normals[0];
        Touch touch = random_touch(m, random, 1.2, 0.3);
        touch.point = touch.point + (random.below(2) ? 0.5 : 0.0) * cross(normal, random.normal3());
        const Wrench w = touch.wrench();
        const Query q = contactbench::make_query(m.frame, w);
        contactbench::EdgeMoments moments;
        const bool accepted = contactbench::accepts(m.tree.edges[0], m.tree.triangle[0], q, moments);
        double x[4];
        if (!CHECK(solve_directly(w, normal, mesh.vertices[0], x))) continue;
        const Vec3 p{x[0], x[1], x[2]};
        // Signed areas that the solution spans with each edge, all positive inside.
        double least = 1.0, total = 0.0, area[3];
        for (std::size_t e = 0; e < 3; ++e) {
            const Vec3 a = mesh.vertices[e], b = mesh.vertices[(e + 1) % 3];
            area[e] = dot(normal, cross(a - p, b - p));
            total += area[e];
        }
        for (const double part : area) least = std::min(least, part / total);
        if (std::fabs(least) > 1e-9) CHECK(accepted == (least > 0.0));
        if (!accepted) continue;
        const Candidate c = contactbench::facet_contact(m, 0, moments.w, q);
        const double size = norm(p) + m.frame.scale;
        CHECK(norm(c.point - p) <= 1e-9 * size);
        CHECK(close(c.torque, x[3], 1e-9, norm(w.M)));
        for (std::size_t e = 0; e < 3; ++e)  // the moments are the barycentric weights
            CHECK(close(moments.w[e] / (moments.w[0] + moments.w[1] + moments.w[2]), area[e] / total, 1e-9, 1.0));
        CHECK(norm(cross(c.point, w.F) + c.torque * c.normal - w.M) <= 1e-9 * (norm(w.M) + size * norm(w.F)));
    }
}

// Points exactly on edges and vertices of a mesh whose coordinates are whole numbers, so that w is
// exactly zero there: the tie rule alone decides.
inline void check_ties() {
    const Model m = model_of(subdivide(subdivide(octahedron())));
    Random random(2);
    for (int i = 0; i < 20000; ++i) {
        const Triangle& t = m.tree.triangle[std::size_t(m.slot[random.below(m.normals.size())])];
        const bool at_vertex = random.below(2) == 0;
        const Vec3 a = m.vertices[std::size_t(t[0])], b = m.vertices[std::size_t(t[1])];
        const Vec3 p = at_vertex ? a : 0.5 * (a + b);
        Vec3 f;
        do {
            f = {double(random.below(9)) - 4.0, double(random.below(9)) - 4.0, double(random.below(9)) - 4.0};
        } while (norm(f) == 0.0);
        const Query q = contactbench::make_query(m.frame, {f, cross(p, f)});
        bool all_push = true;
        for (std::size_t face = 0; face < m.normals.size(); ++face)
            for (std::int32_t v : m.tree.triangle[std::size_t(m.slot[face])])
                if (v == t[0] || (!at_vertex && v == t[1])) all_push &= dot(m.normals[face], q.f) < -1e-9;
        if (!all_push) continue;
        Hits hits;
        contactbench::exhaust(m, q, 1e-9, hits);
        int facets = 0, all = 0;
        for (std::size_t h = 0; h < hits.size(); ++h)
            if (norm(hits[h].point - p) < 1e-12) ++all, facets += hits[h].vertex < 0;
        CHECK(all >= 1);
        if (!at_vertex) CHECK(facets == 1 && all == 1);
    }
}

// The wrench of a touch at a vertex with its torque along one facet's normal: that facet's solution is
// the vertex itself, where the peak test sees edges at a right angle to the moment.
inline void check_torque_along_a_facet_normal() {
    Random random(3);
    for (const Mesh& mesh : {sphere(3), ellipsoid(3), octahedron(), box()}) {
        const Model m = model_of(mesh);
        for (int i = 0; i < 5000; ++i) {
            Touch touch = random_touch(m, random, 0.7, 0.1);
            const auto by_normal = [&](std::size_t face) { return norm(m.normals[face] - touch.normal) == 0.0; };
            std::size_t face = 0;
            while (!by_normal(face)) ++face;
            touch.point = mesh.vertices[std::size_t(mesh.faces[face][random.below(3)])];
            const Query q = contactbench::make_query(m.frame, touch.wrench());
            Hits hits;
            contactbench::exhaust(m, q, 1e-6, hits);
            CHECK(hits.size() >= 1);
        }
    }
}

// Discrete one-forms on a closed surface: facets all of one sign, vertices all of one sign, less half
// the sign changes around a vertex beyond the first two, sum to the Euler number. The tie rule gives
// every edge one sign, so it holds for every wrench, exactly.
inline int index_sum(const Mesh& mesh, const Model& m, const Query& q) {
    const auto negative = [&](std::int32_t half_edge) {
        const std::int32_t from = mesh.faces[std::size_t(half_edge / 3)][std::size_t(half_edge % 3)];
        const auto slot = std::size_t(m.slot[std::size_t(half_edge / 3)]);
        const Triangle& t = m.tree.triangle[slot];
        const int edge = t[0] == from ? 0 : t[1] == from ? 1 : 2;
        return contactbench::edge_negative(edge, contactbench::rises(t),
                                           contactbench::edge_moment(m.tree.edges[slot], edge, q));
    };
    int sum = 0;
    for (std::int32_t f = 0; f < std::int32_t(mesh.faces.size()); ++f) {
        const int count = int(negative(3 * f)) + int(negative(3 * f + 1)) + int(negative(3 * f + 2));
        sum += count == 0 || count == 3;
    }
    for (std::int32_t v = 0; v < std::int32_t(mesh.vertices.size()); ++v) {
        const auto [first, last] = m.topology.fan(v);
        int changes = 0;
        for (auto h = first; h != last; ++h) changes += negative(*h) != negative(h + 1 == last ? *first : h[1]);
        sum += 1 - changes / 2;
    }
    return sum;
}

inline void check_index_theorem() {
    Random random(4);
    for (const Mesh& mesh : {sphere(3), ellipsoid(3), t_shape(3), torus(30, 12), two_pieces(2), box(), urchin(3, 3)}) {
        const Model m = model_of(mesh);
        CHECK(m.topology.closed());
        for (const double pitch : {0.0, 0.01, 1.0, 100.0})
            for (int i = 0; i < 75; ++i) {
                Touch touch = random_touch(m, random, 1.5707, pitch);
                if (i % 3 == 0) touch.point = mesh.vertices[random.below(mesh.vertices.size())];
                CHECK(index_sum(mesh, m, contactbench::make_query(m.frame, touch.wrench())) == mesh.euler);
            }
    }
}

inline void check_jacobian() {
    Random random(5);
    const Model m = model_of(ellipsoid(2));
    for (int i = 0; i < 3000; ++i) {
        const Touch touch = random_touch(m, random, 1.0, 0.02);
        const auto j = contactbench::point_jacobian(touch.point, touch.normal, touch.force);
        const auto solve = [&](int channel, double step) {
            double v[6] = {};
            v[channel] = step;
            Wrench w = touch.wrench();
            w.F = w.F + Vec3{v[0], v[1], v[2]};
            w.M = w.M + Vec3{v[3], v[4], v[5]};
            double x[4];
            solve_directly(w, touch.normal, touch.point, x);
            return Vec3{x[0], x[1], x[2]};
        };
        for (int c = 0; c < 6; ++c) {
            const double step = (c < 3 ? 1e-5 : 1e-7) * norm(touch.force);
            const Vec3 slope = (0.5 / step) * (solve(c, step) - solve(c, -step));
            const Vec3 mine{j.j[0][c], j.j[1][c], j.j[2][c]};
            CHECK(norm(slope - mine) <= 1e-6 * (norm(mine) + (c < 3 ? m.reach : 1.0) / norm(touch.force)));
        }
    }
}

inline void check_facets() {
    check_against_direct_solve();
    check_ties();
    check_torque_along_a_facet_normal();
    check_index_theorem();
    check_jacobian();
}

}  // namespace testing
