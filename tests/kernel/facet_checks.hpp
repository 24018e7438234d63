// One facet at a time: the best touch on it, how sure it is, and what is known of it before it is looked at in full.
#pragma once

#include "reference.hpp"

namespace testing {

using contactbench::Query;
using contactbench::Uncertainty;

// A wrench, its noise and the probe that it presses on.
struct Case {
    Wrench wrench;
    WrenchCovariance noise;
    double arm = 1e-3;

    Query query(const Model& m) const {
        Query q = contactbench::make_query(m.frame, wrench, Uncertainty(noise, m.frame));
        contactbench::set_arm(m.frame, arm, q);
        return q;
    }
    Definition definition(const Model& m) const { return {wrench, noise, arm, m.frame.centre, m.frame.scale}; }
};

// How far rounding may move d2: each number of r by `eps`, of which sqrt(d2) counts how many deviations it is off.
inline double rounding(double d2, const Definition& d, const Flat& flat) {
    const Real far = length(d.middle) + length(d.axis - d.middle) + std::fabs(d.pitch) / d.force;
    const Real eps = 2e-15L * d.force * (d.size + far);
    const Whitened W = d.whitened(d.depth_on(flat), flat);
    const Real off = eps * (length(W({1, 0, 0})) + length(W({0, 1, 0})) + length(W({0, 0, 1})));
    return double(1e-9L * (1 + d2) + 2 * std::sqrt(Real(d2)) * off + off * off);
}

// The least of a convex function between two ends, by golden sections.
template <class Function>
Real least_between(Real lo, Real hi, Function&& value) {
    const Real golden = (std::sqrt(5.0L) - 1) / 2;
    Real a = hi - golden * (hi - lo), b = lo + golden * (hi - lo), at_a = value(a), at_b = value(b);
    for (int i = 0; i < 44; ++i) {
        if (at_a < at_b) {
            hi = b, b = a, at_b = at_a;
            at_a = value(a = hi - golden * (hi - lo));
        } else {
            lo = a, a = b, at_a = at_b;
            at_b = value(b = lo + golden * (hi - lo));
        }
    }
    return std::min({at_a, at_b, value(lo), value(hi)});
}

// The least of d2 over a triangle, with nothing but values of d2.
inline Real least_by_search(const Definition& d, const Flat& flat) {
    const Whitened W = d.whitened(d.depth_on(flat), flat);
    const Real3 p = flat.corner[0], u = flat.corner[1] - p, v = flat.corner[2] - p;
    return least_between(0, 1, [&](Real a) {
        return least_between(0, 1 - a, [&](Real b) {
            const Real3 r = W(d.residual(p + (a * u + b * v)));
            return inner(r, r);
        });
    });
}

// A random triangle, anywhere, with random errors of the mesh, and a wrench that pushes it more or less.
struct RandomFacet {
    Mesh mesh;
    Model model;
    Flat flat;
    contactbench::MeshError<double> error;
    Case situation;
    double cosine = 0.0;

    explicit RandomFacet(Random& random) {
        const double size = std::pow(10.0, random.uniform(-3, 1));
        const Vec3 place = random.below(2) ? Vec3{} : (30.0 * size * random.unit()) * random.direction();
        mesh = {"random", {random.normal3(), random.normal3(), random.normal3()}, {{0, 1, 2}}};
        if (random.below(8) == 0) mesh.vertices[2] = mesh.vertices[0] + 1e-3 * random.normal3();
        for (Vec3& p : mesh.vertices) p = place + size * p;
        model = contactbench::make_model(mesh.vertices, mesh.faces, {});
        flat = flats_of(mesh, model)[0];
        const double bend = random.below(2) ? 0.3 * random.unit() : 0.0, spread = random.below(2) ? 0.1 * random.unit() : 0.0;
        error = {spread * spread, bend * bend};
        flat.bend = error.bend, flat.spread = Real(error.spread) * model.frame.scale * model.frame.scale;
        const double precision = std::pow(10.0, random.uniform(-3, 1));
        situation.noise = mixed_noise(random, 0.05 * precision, 0.1 * size * precision);
        situation.arm = size * std::pow(10.0, random.uniform(-4, 1));
        Touch touch = random_touch(model, random, 1.55, random.below(3) ? 0.05 * random.normal() : 0.0);
        touch.point = touch.point + (random.below(2) ? 0.3 * size : 0.0) * random.normal3();
        situation.wrench = touch.wrench();
        cosine = -dot(model.normals[0], touch.force) / norm(touch.force);
    }
};

inline contactbench::FacetFit fit(const RandomFacet& r, const Query& q) {
    const Vec3 corners[3] = {r.model.normalised(0), r.model.normalised(1), r.model.normalised(2)};
    return contactbench::fit_facet(corners, r.model.normals[0], r.error, q);
}

// The closed form against d2 as it is defined, minimised twice: by golden sections and as a quadratic.
inline void check_fit() {
    Random random(1);
    int inside = 0, on_edge = 0, on_corner = 0;
    for (int i = 0; i < 6000; ++i) {
        const RandomFacet r(random);
        if (!(r.cosine > 1e-3)) continue;
        const Query q = r.situation.query(r.model);
        const Definition d = r.situation.definition(r.model);
        const contactbench::FacetFit mine = fit(r, q);
        const Place want = d.best(r.flat);
        const double off = rounding(double(want.d2), d, r.flat);
        CHECK(std::fabs(mine.d2 - double(want.d2)) <= off);
        if (i % 8 == 0) CHECK(std::fabs(mine.d2 - double(least_by_search(d, r.flat))) <= off);
        CHECK(close(mine.cosine, double(want.cosine), 1e-9));
        double total = 0.0;
        int positive = 0;
        Real3 point;
        for (int c = 0; c < 3; ++c) {
            CHECK(mine.weight[c] >= 0.0 && mine.weight[c] <= 1.0);
            total += mine.weight[c];
            positive += mine.weight[c] > 0.0;
            point = point + Real(mine.weight[c]) * r.flat.corner[c];
        }
        ++(positive == 3 ? inside : positive == 2 ? on_edge : on_corner);
        CHECK(std::fabs(total - 1.0) <= 4e-15);
        // The weights are of the point where it is least, and the torsion is the mean of what k can be there.
        const Real3 rest = d.residual(point), told = d.whitened(d.depth_on(r.flat), r.flat)(rest);
        CHECK(std::fabs(double(inner(told, told) - want.d2)) <= off);
        const double torque = mine.torsion * q.force * r.model.frame.scale;
        CHECK(std::fabs(torque - double(want.torque)) <=
              1e-6 * std::fabs(double(want.torque)) + 1e-11 * double(d.force * (d.size + length(d.middle))));
    }
    CHECK(inside > 200 && on_edge > 200 && on_corner > 200);
}

// The 4x4 system p x F + k n = M, n . p = n . p0 by Gauss-Jordan elimination with pivoting: x, y, z, k.
inline bool solve_directly(const Wrench& w, Vec3 n, Vec3 on_plane, double x[4]) {
    double a[4][5] = {{0, w.F.z, -w.F.y, n.x, w.M.x},
                      {-w.F.z, 0, w.F.x, n.y, w.M.y},
                      {w.F.y, -w.F.x, 0, n.z, w.M.z},
                      {n.x, n.y, n.z, 0, dot(n, on_plane)}};
    for (int c = 0; c < 4; ++c) {
        int pivot = c;
        for (int r = c + 1; r < 4; ++r)
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

// The least weight of a point on the triangle's plane; negative outside.
inline double least_weight(const Mesh& mesh, const Triangle& t, Vec3 n, Vec3 p) {
    double area[3], least = HUGE_VAL;
    for (std::size_t e = 0; e < 3; ++e)
        area[e] = dot(n, cross(mesh.vertices[std::size_t(t[e])] - p, mesh.vertices[std::size_t(t[(e + 1) % 3])] - p));
    for (const double part : area) least = std::min(least, part / (area[0] + area[1] + area[2]));
    return least;
}

// An arm beyond all bounds is the closed form: nothing is left where a facet holds a solution, which is the touch.
// An arm of nothing is the wrench axis: the point next to it, if torques in every direction are as uncertain.
inline void check_limits() {
    Random random(2);
    int held = 0, crossed = 0;
    for (int i = 0; i < 4000; ++i) {
        RandomFacet r(random);
        if (!(r.cosine > 0.05)) continue;
        r.error = {};
        r.situation.arm = 1e4 * r.model.frame.scale;
        r.situation.noise = mixed_noise(random, 1e-4, 1e-5 * r.model.frame.scale);
        const Vec3 p = r.mesh.vertices[0], n = r.model.normals[0];
        double x[4];
        if (!CHECK(solve_directly(r.situation.wrench, n, p, x))) continue;
        const double least = least_weight(r.mesh, r.mesh.faces[0], n, {x[0], x[1], x[2]});
        if (std::fabs(least) > 1e-3) {
            const contactbench::FacetFit wide = fit(r, r.situation.query(r.model));
            CHECK((least > 0.0) == (wide.d2 < 1e-3));
            if (least > 0.0) {
                ++held;
                Vec3 found;
                for (std::size_t c = 0; c < 3; ++c) found = found + wide.weight[c] * r.mesh.vertices[c];
                CHECK(norm(found - Vec3{x[0], x[1], x[2]}) < 1e-6 * r.model.frame.scale);
                CHECK(close(wide.torsion * norm(r.situation.wrench.F) * r.model.frame.scale, x[3], 1e-6,
                            1e-6 * norm(r.situation.wrench.F) * r.model.frame.scale));
            }
        }
        // No pitch to explain: with an arm of zero it only adds h^2 / S_ff.
        WrenchCovariance even;
        for (int k = 3; k < 6; ++k) even.s[k][k] = std::pow(1e-3 * r.model.frame.scale, 2);
        r.situation.noise = even;
        r.situation.arm = 0.0;
        const Query q = r.situation.query(r.model);
        const contactbench::FacetFit narrow = fit(r, q);
        const Definition d = r.situation.definition(r.model);
        const auto from_axis = [&](Real3 at) { return length(outer(at - d.axis, d.f)); };
        Real nearest = HUGE_VAL;
        for (int a = 0; a <= 40; ++a)
            for (int b = 0; a + b <= 40; ++b)
                nearest = std::min(nearest, from_axis((a / 40.0L) * r.flat.corner[0] + ((b / 40.0L) * r.flat.corner[1] +
                                                      ((40 - a - b) / 40.0L) * r.flat.corner[2])));
        Real3 found;
        for (int c = 0; c < 3; ++c) found = found + Real(narrow.weight[c]) * r.flat.corner[c];
        CHECK(from_axis(found) <= nearest + 1e-9L * d.size);
        CHECK(narrow.torsion == 0.0);
        const double sigma = std::hypot(1e-3 / double(d.force), 1e-6) * r.model.frame.scale;
        const double miss = double(from_axis(found)) / sigma, pitch = double(d.pitch / d.force) / sigma;
        CHECK(close(narrow.d2, miss * miss + pitch * pitch, 1e-6, 1.0));
        crossed += miss < 1e-6;
    }
    CHECK(held > 500 && crossed > 500);
}

// How sure a touch is: against d2 differentiated numerically, and against touches located from wrenches that were
// drawn with their noise and torsion.
inline void check_plane_covariance() {
    Random random(3);
    for (int i = 0; i < 400; ++i) {
        RandomFacet r(random);
        if (!(r.cosine > 0.1)) continue;
        const Query q = r.situation.query(r.model);
        const Definition d = r.situation.definition(r.model);
        const Vec3 n = r.model.normals[0];
        const Real3 point = d.best(r.flat).point;
        const Real depth = inner(point - d.middle, d.f);
        const contactbench::Mat3 mine = contactbench::plane_covariance(r.model.frame, q, n, double(depth / d.size), r.error);
        // d2 about the point by central differences: of a quadratic they are exact.
        const Whitened W = d.whitened(depth, r.flat);
        Real3 s = outer(r.flat.normal, random.direction());
        s = (1 / length(s)) * s;
        const Real3 axes[2] = {s, outer(r.flat.normal, s)};
        const Real step = 0.01L * d.size;
        Real curve[2][2];
        const auto d2 = [&](Real a, Real b) {
            const Real3 rest = W(d.residual(point + (a * step * axes[0] + b * step * axes[1])));
            return inner(rest, rest);
        };
        curve[0][0] = (d2(1, 0) - 2 * d2(0, 0) + d2(-1, 0)) / 2;
        curve[1][1] = (d2(0, 1) - 2 * d2(0, 0) + d2(0, -1)) / 2;
        curve[0][1] = curve[1][0] = (d2(1, 1) - d2(1, -1) - d2(-1, 1) + d2(-1, -1)) / 8;
        const Real det = curve[0][0] * curve[1][1] - curve[0][1] * curve[1][0];
        const Real want[2][2] = {{step * step * curve[1][1] / det, -step * step * curve[0][1] / det},
                                 {-step * step * curve[0][1] / det, step * step * curve[0][0] / det}};
        Real33 own;
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l) own.m[k][l] = mine.m[k][l];
        const Real largest = want[0][0] + want[1][1];
        for (int k = 0; k < 2; ++k)
            for (int l = 0; l < 2; ++l)
                CHECK(std::fabs(inner(axes[k], own(axes[l])) - want[k][l]) <= 1e-6L * largest);
        CHECK(length(own(r.flat.normal)) <= 1e-9L * largest);
        const std::array<Vec3, 2> half = contactbench::ellipse_axes(mine, n);
        Real33 again;
        for (const Vec3& axis : half) again.add(1, axis, axis);
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l) CHECK(std::fabs(again.m[k][l] - own.m[k][l]) <= 1e-9L * largest);
        CHECK(norm(half[0]) >= norm(half[1]));
    }
    // Monte Carlo: the middle of a large facet, small errors, so that nothing but they move the touch.
    for (int i = 0; i < 6; ++i) {
        const Mesh mesh{"plate", {{-10, -10, 0}, {10, -10, 0}, {0, 20, 0}}, {{0, 1, 2}}};
        const Model model = contactbench::make_model(mesh.vertices, mesh.faces, {});
        Case c;
        c.noise = mixed_noise(random, 0.01, 0.002);
        c.arm = i % 2 ? 3e-3 : 1e-4;
        Touch touch;
        touch.point = {0.1 * random.normal(), 0.1 * random.normal(), 0.0};
        touch.normal = {0, 0, 1};
        touch.force = {2.0 * random.normal(), 2.0 * random.normal(), -10.0};
        const contactbench::MeshError<double> none;
        double lower[6][6] = {};  // of the noise, after Cholesky
        for (int k = 0; k < 6; ++k)
            for (int l = 0; l <= k; ++l) {
                double sum = c.noise.s[k][l];
                for (int j = 0; j < l; ++j) sum -= lower[k][j] * lower[l][j];
                lower[k][l] = k == l ? std::sqrt(sum) : sum / lower[l][l];
            }
        double sums[2][2] = {};
        constexpr int draws = 6000;
        for (int k = 0; k < draws; ++k) {
            double white[6], e[6] = {};
            for (double& x : white) x = random.normal();
            for (int a = 0; a < 6; ++a)
                for (int b = 0; b <= a; ++b) e[a] += lower[a][b] * white[b];
            touch.torque = c.arm * norm(touch.force) * random.normal();
            const Wrench clean = touch.wrench();
            c.wrench = {clean.F + Vec3{e[0], e[1], e[2]}, clean.M + Vec3{e[3], e[4], e[5]}};
            const Vec3 corners[3] = {model.normalised(0), model.normalised(1), model.normalised(2)};
            const contactbench::FacetFit found = contactbench::fit_facet(corners, touch.normal, none, c.query(model));
            Vec3 p;
            for (std::size_t v = 0; v < 3; ++v) p = p + found.weight[v] * mesh.vertices[v];
            const double off[2] = {p.x - touch.point.x, p.y - touch.point.y};
            for (int a = 0; a < 2; ++a)
                for (int b = 0; b < 2; ++b) sums[a][b] += off[a] * off[b] / draws;
        }
        touch.torque = 0.0;
        c.wrench = touch.wrench();
        const Query q = c.query(model);
        const Vec3 at = (1.0 / model.frame.scale) * (touch.point - model.frame.centre);
        const contactbench::Mat3 told = contactbench::plane_covariance(model.frame, q, touch.normal, dot(at, q.f), none);
        // Six standard deviations of a sample variance.
        for (int a = 0; a < 2; ++a)
            for (int b = 0; b < 2; ++b)
                CHECK(std::fabs(told.m[a][b] - sums[a][b]) <=
                      6.0 * std::sqrt(2.0 / draws) * std::sqrt(told.m[a][a] * told.m[b][b]));
    }
}

// Duplicates, rims and sharp edges bend nothing; an even surface bends as much as its neighbours turn.
inline void check_mesh_errors() {
    for (const Mesh& mesh : zoo())
        for (const contactbench::MeshTerms terms : {contactbench::MeshTerms{}, {2e-4, true}, {1e-4, false}}) {
            const Model m = contactbench::make_model(mesh.vertices, mesh.faces, {}, {}, terms);
            const std::vector<Flat> flats = flats_of(mesh, m, terms);
            for (const Flat& flat : flats) {
                const contactbench::MeshError<double>& e = m.errors[std::size_t(flat.face)];
                // The angle's own rounding: an arc cosine near one.
                CHECK(std::fabs(std::sqrt(e.bend) - double(std::sqrt(flat.bend))) <= 1e-7);
                CHECK(std::fabs(std::sqrt(e.spread) - double(std::sqrt(flat.spread)) / m.frame.scale) <= 1e-7);
                CHECK(double(length(Real3(m.normals[std::size_t(flat.face)]) - flat.normal)) <= 1e-6);
            }
        }
    // A sphere of 30 mm: what the facets leave open shrinks with their size squared.
    const Mesh coarse = sphere(3), fine = sphere(4);
    const auto worst = [](const Mesh& mesh) {
        double most = 0.0;
        const Model m = contactbench::make_model(mesh.vertices, mesh.faces, {});
        for (const contactbench::MeshError<double>& e : m.errors) most = std::max(most, std::sqrt(e.spread) * m.frame.scale);
        return most;
    };
    CHECK(worst(coarse) > 4e-5 && worst(coarse) < 1e-3);
    CHECK(close(worst(fine), worst(coarse) / 4, 0.2));
}

inline void check_facets() {
    check_fit();
    check_limits();
    check_plane_covariance();
    check_mesh_errors();
}

}  // namespace testing
