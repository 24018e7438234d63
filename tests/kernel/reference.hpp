// What the kernel has to say, from the definition in likelihood.hpp and by brute force: S is built from its definition
// and whitened by, every facet is minimised over, and the answer is chosen among all of them. Slow, in long double and SI,
// and nothing is shared with the headers under test but the structs that carry numbers.
#pragma once

#include <algorithm>
#include <optional>

#include "meshes.hpp"

namespace testing {

using contactbench::Gates;
using contactbench::Reason;
using contactbench::Why;
using Real = long double;

inline constexpr Real half_turn = 3.14159265358979323846L;

struct Real3 {
    Real x = 0, y = 0, z = 0;

    Real3() = default;
    Real3(Real a, Real b, Real c) : x(a), y(b), z(c) {}
    Real3(Vec3 v) : x(v.x), y(v.y), z(v.z) {}
    Vec3 rounded() const { return {double(x), double(y), double(z)}; }
};

inline Real3 operator+(Real3 a, Real3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Real3 operator-(Real3 a, Real3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Real3 operator*(Real s, Real3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline Real inner(Real3 a, Real3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Real3 outer(Real3 a, Real3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Real length(Real3 a) { return std::sqrt(inner(a, a)); }

struct Real33 {
    Real m[3][3] = {};

    void add(Real times, Real3 a, Real3 b) {
        const Real u[3] = {a.x, a.y, a.z}, v[3] = {b.x, b.y, b.z};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) m[i][j] += times * u[i] * v[j];
    }
    Real3 operator()(Real3 a) const {
        return {m[0][0] * a.x + m[0][1] * a.y + m[0][2] * a.z, m[1][0] * a.x + m[1][1] * a.y + m[1][2] * a.z,
                m[2][0] * a.x + m[2][1] * a.y + m[2][2] * a.z};
    }
};

// r in standard deviations of S, so that inner(W(u), W(v)) is u^T S^-1 v. `n` is the direction in which S may be larger
// than elsewhere by more digits than numbers have: what it is more by comes by itself.
class Whitened {
public:
    Whitened(const Real33& s, Real3 n, Real more) {
        const Real3 seed = std::fabs(n.x) < 0.6L ? Real3(1, 0, 0) : Real3(0, 1, 0);
        axis_[0] = n;
        axis_[1] = outer(n, seed);
        axis_[1] = (1 / length(axis_[1])) * axis_[1];
        axis_[2] = outer(n, axis_[1]);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j <= i; ++j) {  // Cholesky
                Real sum = inner(axis_[i], s(axis_[j])) + (i == 0 ? more : 0);
                for (int k = 0; k < j; ++k) sum -= lower_[i][k] * lower_[j][k];
                lower_[i][j] = i == j ? std::sqrt(sum) : sum / lower_[j][j];
            }
    }
    Real3 operator()(Real3 r) const {
        Real out[3];
        for (int i = 0; i < 3; ++i) {
            out[i] = inner(axis_[i], r);
            for (int k = 0; k < i; ++k) out[i] -= lower_[i][k] * out[k];
            out[i] /= lower_[i][i];
        }
        return {out[0], out[1], out[2]};
    }

private:
    Real3 axis_[3];
    Real lower_[3][3] = {};
};

// A facet: m, m^2, rad^2.
struct Flat {
    Real3 corner[3], normal;
    Real spread = 0, bend = 0;
    double bonus = 0;
    std::int32_t face = -1, region = 0;
    std::array<std::int32_t, 3> vertex{-1, -1, -1};
};

// As the page says of equals.
inline Real rounded(Real x) { return std::rint(x * 16777216.0L); }

// The best touch on it.
struct Place {
    const Flat* flat = nullptr;
    Real d2 = 0, cosine = 0, torque = 0;
    Real across = 0;  // of those that are chosen among: largest standard deviation seen along the force
    Real weight[3] = {};
    Real3 point;
    std::int32_t vertex = -1;
    bool nearly_corner = false;  // or hardly one: rounding decides
    Real prior = 0, follow = 0, behind = 0;
    Real depth = 0;  // m, of the first: what other surfaces of its place leave open along the force
    Why why = Why::misfit;

    Real without() const { return d2 - follow + behind; }
    Real cost() const { return without() - prior; }
    Real unhidden() const { return d2 - follow - prior; }
};

// One wrench against one probe.
class Definition {
public:
    Definition(const Wrench& w, const WrenchCovariance& noise, double arm, Vec3 centre, double scale)
        : F(w.F), M(w.M), middle(centre), force(length(F)), size(scale), f((1 / force) * F),
          arm_(arm), noise_(noise) {
        const Real3 moment = M - outer(middle, F);
        pitch = inner(moment, f);
        foot = (1 / force) * outer(f, moment);
        // Beyond the mesh the errors are those at its border.
        if (length(foot) > 1.75L * size) foot = (1.75L * size / length(foot)) * foot;
        axis = middle + (1 / force) * outer(f, moment);
    }

    // By S at `depth` along the force from the middle, on a facet.
    Whitened whitened(Real depth, const Flat& flat) const {
        const Real3 p = middle + foot + depth * f;
        // r is off by e_M - p x e_F.
        const Real A[3][6] = {{0, p.z, -p.y, 1, 0, 0}, {-p.z, 0, p.x, 0, 1, 0}, {p.y, -p.x, 0, 0, 0, 1}};
        Real33 s;
        Real AC[3][6] = {};
        for (int i = 0; i < 3; ++i)
            for (int l = 0; l < 6; ++l)
                for (int k = 0; k < 6; ++k) AC[i][l] += A[i][k] * Real(noise_.s[k][l]);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                for (int l = 0; l < 6; ++l) s.m[i][j] += AC[i][l] * A[j][l];
        // The surface moved along its normal, and its normal turned: k = pitch / c.
        const Real3 shift = outer(flat.normal, F);
        s.add(flat.spread, shift, shift);
        const Real torsion = pitch / -inner(flat.normal, f), turned = flat.bend * torsion * torsion;
        const Real3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (const Real3& e : axes) s.add(turned + 1e-12L * force * force * size * size, e, e);
        s.add(-turned, f, f);
        return {s, flat.normal, arm_ * force * arm_ * force};
    }

    // Where S is taken: the axis meets the facet's plane, but no further than the facet reaches.
    Real depth_on(const Flat& flat) const {
        const Real c = -inner(flat.normal, f);
        const Real met = inner(flat.normal, axis - flat.corner[0]) / c;
        Real least = HUGE_VAL, most = -HUGE_VAL;
        for (const Real3& p : flat.corner) {
            least = std::min(least, inner(p - middle, f));
            most = std::max(most, inner(p - middle, f));
        }
        return std::min(std::max(met, least), most);
    }

    Real3 residual(Real3 p) const { return M - outer(p, F); }

    // d2 is a convex quadratic of the weights: inside, or on one of the three edges. All are tried, the least counts.
    Place best(const Flat& flat) const {
        Place out;
        out.flat = &flat;
        out.prior = flat.bonus;
        out.cosine = -inner(flat.normal, f);
        const Whitened W = whitened(depth_on(flat), flat);
        out.d2 = HUGE_VAL;
        const auto attempt = [&](Real a, Real b, Real c) {
            const Real3 p = a * flat.corner[0] + (b * flat.corner[1] + c * flat.corner[2]), r = W(residual(p));
            if (!(inner(r, r) < out.d2)) return;
            out.d2 = inner(r, r), out.point = p;
            out.weight[0] = a, out.weight[1] = b, out.weight[2] = c;
        };
        const Real3 r0 = W(residual(flat.corner[0])), u = W(outer(flat.corner[1] - flat.corner[0], F)),
                    v = W(outer(flat.corner[2] - flat.corner[0], F));
        const Real uu = inner(u, u), uv = inner(u, v), vv = inner(v, v), ru = inner(r0, u), rv = inner(r0, v);
        const Real det = uu * vv - uv * uv, b = (ru * vv - rv * uv) / det, c = (rv * uu - ru * uv) / det;
        if (b >= 0 && c >= 0 && b + c <= 1) attempt(1 - b - c, b, c);
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            const Real3 r = W(residual(flat.corner[i])), e = W(outer(flat.corner[j] - flat.corner[i], F));
            const Real s = inner(r, e) / inner(e, e), held = std::min(std::max(s, Real(0)), Real(1));
            Real weight[3] = {};
            weight[i] = 1 - held, weight[j] = held;
            attempt(weight[0], weight[1], weight[2]);
            out.nearly_corner |= std::fabs(s) < 1e-7L || std::fabs(s - 1) < 1e-7L;
        }
        for (int i = 0; i < 3; ++i)
            if (out.weight[i] >= 1 - 1 / 16777216.0L) out.vertex = flat.vertex[std::size_t(i)];
        out.torque = arm_ * force * arm_ * force * inner(W(flat.normal), W(residual(out.point)));
        return out;
    }

    // Covariance of the touch along the plane: twice the inverse of d2's second derivative there. In m^2.
    Real33 spread_of_touch(Real3 point, const Flat& flat) const {
        const Whitened W = whitened(inner(point - middle, f), flat);
        const Real3 seed = std::fabs(flat.normal.x) < 0.6L ? Real3(1, 0, 0) : Real3(0, 1, 0);
        Real3 s = outer(flat.normal, seed);
        s = (1 / length(s)) * s;
        const Real3 t = outer(flat.normal, s), u = W(outer(s, F)), v = W(outer(t, F));
        const Real uu = inner(u, u), uv = inner(u, v), vv = inner(v, v), det = uu * vv - uv * uv;
        Real33 out;
        out.add(vv / det, s, s);
        out.add(-uv / det, s, t);
        out.add(-uv / det, t, s);
        out.add(uu / det, t, t);
        return out;
    }

    // The largest standard deviation of the touch, seen along the force.
    Real across(Real3 point, const Flat& flat) const {
        const Real33 c = spread_of_touch(point, flat);
        const Real3 seed = std::fabs(f.x) < 0.6L ? Real3(1, 0, 0) : Real3(0, 1, 0);
        Real3 s = outer(f, seed);
        s = (1 / length(s)) * s;
        const Real3 t = outer(f, s);
        const Real ss = inner(s, c(s)), st = inner(s, c(t)), tt = inner(t, c(t));
        return std::sqrt((ss + tt + std::sqrt((ss - tt) * (ss - tt) + 4 * st * st)) / 2);
    }

    // How far p is from a touch, what lies down its slope counted as it is seen along the force.
    Real apart(const Place& touch, Real3 p) const {
        const Real3 d = p - touch.point;
        const Real sine = std::sqrt(std::max(Real(0), 1 - touch.cosine * touch.cosine));
        if (sine < 1e-12L) return length(d);
        const Real3 down = (1 / sine) * (f + touch.cosine * touch.flat->normal), rest = d - inner(d, down) * down;
        return std::hypot(length(rest), touch.cosine * inner(d, down));
    }

    // Where p lies off the touch's plane against the force, and how far it is along the plane, both over the cosine.
    struct Off {
        Real height, along;
    };
    Off off_plane(const Place& touch, Real3 p) const {
        const Real3 away = p - touch.point, n = touch.flat->normal;
        return {inner(away, n) / touch.cosine, length(away - inner(away, n) * n) / touch.cosine};
    }

    // Without the torsion that it may have.
    Real left_over(const Place& p, Real misfit) const {
        const Real most = std::sqrt(misfit) * arm_ * force, torque = std::min(std::max(p.torque, -most), most);
        return length(residual(p.point) - torque * p.flat->normal);
    }

    Real3 F, M, middle;
    Real force, size;
    Real3 f, foot, axis;
    Real pitch = 0;

private:
    Real arm_;
    const WrenchCovariance& noise_;
};

// What the facets of a curved surface leave open, by looking at every pair that shares an edge.
inline std::vector<Flat> flats_of(const Mesh& mesh, const Model& m, const contactbench::MeshTerms& terms = {},
                                  const std::vector<double>& bonus = {}) {
    std::vector<Flat> flats(mesh.faces.size());
    std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::size_t>> edges;  // from, to
    for (std::size_t i = 0; i < flats.size(); ++i) {
        Flat& flat = flats[i];
        for (std::size_t c = 0; c < 3; ++c) {
            flat.vertex[c] = mesh.faces[i][c];
            // As the header rounds them: far from the sensor that is more than the noise.
            flat.corner[c] = Real3(m.frame.centre) + Real(m.frame.scale) * Real3(m.normalised(flat.vertex[c]));
            edges[{mesh.faces[i][c], mesh.faces[i][(c + 1) % 3]}].push_back(i);
        }
        const Real3 n = outer(flat.corner[1] - flat.corner[0], flat.corner[2] - flat.corner[0]);
        flat.normal = (1 / length(n)) * n;
        flat.face = std::int32_t(i);
        flat.region = m.region(std::int32_t(i));
        if (!bonus.empty()) flat.bonus = bonus[i];
    }
    for (std::size_t i = 0; i < flats.size(); ++i) {
        Real turn = 0, arch = 0;
        for (std::size_t c = 0; c < 3 && terms.curved; ++c) {
            const std::int32_t a = mesh.faces[i][c], b = mesh.faces[i][(c + 1) % 3];
            const auto back = edges.find({b, a});
            if (edges[{a, b}].size() != 1 || back == edges.end() || back->second.size() != 1) continue;
            const Flat &one = flats[i], &two = flats[back->second[0]];
            const Real angle = std::atan2(length(outer(one.normal, two.normal)), inner(one.normal, two.normal));
            if (angle > 40.0L / 180 * half_turn) continue;
            Real3 between;
            for (std::size_t k = 0; k < 3; ++k) between = between + (1 / 3.0L) * (one.corner[k] - two.corner[k]);
            turn = std::max(turn, angle);
            arch = std::max(arch, angle * length(between));
        }
        flats[i].bend = 0.5L * turn * 0.5L * turn;
        flats[i].spread = 0.7L / 8 * arch * 0.7L / 8 * arch + Real(terms.deviation) * Real(terms.deviation);
    }
    return flats;
}

// How near to each other two numbers hang on it.
inline Real rounding_of(Real a) { return 1e-8L * (1 + std::fabs(a)); }

// The answer, from all facets. `doubtful`: a comparison hangs on rounding.
struct Verdict {
    Reason reason = Reason::implausible;
    int chosen = -1;
    std::vector<Place> places;
    Real confidence = 0, misfit = NAN, left_over = NAN;
    bool doubtful = false;

    bool less(Real a, Real b) {
        doubtful |= std::isfinite(a) && std::isfinite(b) && std::fabs(a - b) <= rounding_of(a);
        return a < b;
    }
};

inline bool same_place(const Place& a, const Place& b, Real size) {
    return length(a.point - b.point) < 1e-9L * size && length(a.flat->normal - b.flat->normal) < 1e-9L &&
           a.flat->region == b.flat->region && a.flat->bonus == b.flat->bonus;
}

// Precondition: the wrench passes the gates.
inline Verdict judge(const std::vector<Flat>& flats, const Definition& d, const Gates& g, const Vec3* previous) {
    Verdict v;
    std::vector<Place> all;
    const Real cap = std::max(g.cos_friction, 1e-3) - 1 / 16777216.0L, grazing = std::cos(89.0L / 180 * half_turn);
    const Place* fittest = nullptr;
    bool beyond_the_cone = false;
    for (const Flat& flat : flats) {
        const Real cosine = -inner(flat.normal, d.f);
        if (v.less(cosine, std::min(cap, grazing))) continue;
        Place place = d.best(flat);
        const bool fits = !v.less(g.implausible_misfit, place.d2);
        if (v.less(cosine, cap)) {
            beyond_the_cone |= fits && !v.less(cosine, grazing);
            continue;
        }
        if (previous && !v.less(g.follow_distance / d.size, length(place.point - Real3(*previous)) / d.size))
            place.follow = g.follow_cost;
        all.push_back(place);
    }
    for (const Place& p : all)
        if (!fittest || p.d2 < fittest->d2) fittest = &p;
    if (!fittest || fittest->d2 > g.implausible_misfit) {
        v.reason = beyond_the_cone ? Reason::tangential : fittest ? Reason::implausible : Reason::off_surface;
        if (!fittest) return v;
        v.misfit = fittest->d2;
        v.left_over = d.left_over(*fittest, g.implausible_misfit);
        for (const Place& p : all) v.doubtful |= &p != fittest && p.d2 - v.misfit < rounding_of(v.misfit) && !same_place(p, *fittest, d.size);
        return v;
    }
    std::erase_if(all, [&](const Place& p) { return p.d2 > g.implausible_misfit; });

    const auto own_radius = [&](const Place& p) { return std::max(Real(g.ambiguity_distance), 4.5L * p.across) + 1e-9L; };
    // Further off across the force, or deeper or higher along it than the touch's own surface leads.
    const auto elsewhere = [&](const Place& touch, Real3 p) {
        const Definition::Off off = d.off_plane(touch, p);
        const Real most = g.depth_distance * (1 + 1e-6L) + 0.5L * off.along;
        return v.less(own_radius(touch) / d.size, d.apart(touch, p) / d.size) ||
               (g.depth_distance > 0 && v.less(most / d.size, std::fabs(off.height) / d.size));
    };
    // The line of force meets `front` first, and that is about as likely: the one behind it is the less likely.
    const auto hides = [&](const Place& front, const Place& back) {
        return v.less((g.behind_distance + 1e-9L) / d.size, inner(back.point - front.point, d.f) / d.size) &&
               !v.less(back.unhidden() + g.behind_cost, front.unhidden());
    };
    // The one of least key among those that count, as long as that is within the limit; or null.
    const auto least = [&](const auto& key, Real limit, const auto& counts) -> const Place* {
        const auto rank = [&](const Place& p) {
            return std::make_pair(rounded(key(p)), rounded(inner(p.point - d.middle, d.f) / d.size));
        };
        const Place* best = nullptr;
        for (const Place& p : all)
            if ((!best || rank(p) < rank(*best)) && counts(p)) best = &p;
        if (!best || v.less(limit, key(*best))) return nullptr;
        // What is that near to where numbers are rounded is doubtful.
        for (const Place& p : all)
            if (key(p) - key(*best) < 1e-7L && !same_place(p, *best, d.size) &&
                rounded(key(p) - rounding_of(key(p))) != rounded(key(p) + rounding_of(key(p))))
                v.doubtful |= counts(p);
        v.doubtful |= best->nearly_corner;
        return best;
    };
    // Another touch of the place of `first`, which keeps what chose the place.
    const auto moved = [&](Place to, const Place& first) {
        to.prior = first.prior, to.follow = first.follow;
        to.across = d.across(to.point, *to.flat);
        return to;
    };

    // The likeliest; then, each at another place than those before it, whatever may matter with its odds or without.
    Real least_bonus = -HUGE_VAL, most_bonus = -HUGE_VAL, limit = HUGE_VAL;
    for (const Flat& flat : flats) most_bonus = std::max(most_bonus, Real(flat.bonus));
    const auto key = [&](const Place& p) { return p.d2 - p.follow - std::max(p.prior, least_bonus); };
    bool hidden = false;
    std::vector<Place> layers;
    while (v.places.size() < 8) {
        const Place* best = least(key, limit, [](const Place&) { return true; });
        if (!best) break;
        Place found = moved(*best, *best);
        if (v.places.empty()) {
            least_bonus = found.prior;
            limit = key(found) + g.rival_cost;
            // Odds have chosen the place: in it, the wrench chooses the point.
            const auto inside = [&](const Place& p) { return !elsewhere(found, p.point); };
            const auto misfit = [&](const Place& p) { return p.d2 - most_bonus; };
            if (g.depth_distance > 0 && !g.region_only) found = moved(*least(misfit, HUGE_VAL, inside), found);
            bool rival = false;
            for (const Place& p : all) {
                if (!elsewhere(found, p.point)) layers.push_back(p);
                else rival |= !v.less(found.unhidden() + g.rival_cost - g.behind_cost, p.unhidden()) && !v.less(limit, key(p));
            }
            if (rival || !(g.depth_distance > 0)) layers.clear();
            std::erase_if(layers, [&](const Place& p) {
                const Definition::Off off = d.off_plane(found, p.point);
                return !v.less((0.3L * g.depth_distance * (1 + 1e-6L) + 0.4L * off.along) / d.size, std::fabs(off.height) / d.size) ||
                       v.less(found.d2 + 4, p.d2) || v.less(limit, key(p));
            });
        }
        v.places.push_back(found);
        // What the line of force meets before the likeliest makes that less likely, and others rivals.
        if (!hidden && hides(found, v.places[0])) {
            hidden = true;
            limit += g.behind_cost;
        }
        std::erase_if(all, [&](const Place& p) { return !elsewhere(found, p.point); });
    }

    // Of the surfaces at the first place that are as likely the one that is met first.
    const Place first = v.places[0];
    Real variance = 0, highest = 0;
    const auto height = [&](const Place& p) { return d.off_plane(first, p.point).height; };
    const Place* met = nullptr;
    for (const Place& p : layers) {
        variance = std::max(variance, height(p) * height(p) * std::exp(-std::max(Real(0), p.d2 - first.d2) / 2));
        if (height(p) < 0 || v.less(first.d2 + 0.25L, p.d2)) continue;
        if (!met || rounded(height(p) / g.depth_distance) > rounded(height(*met) / g.depth_distance)) met = &p;
    }
    if (met) {
        for (const Place& p : layers)
            if (std::fabs(height(p) - height(*met)) < 1e-7L * g.depth_distance + 1e-12L * d.size && !same_place(p, *met, d.size))
                v.doubtful |= rounded((height(p) - 1e-12L * d.size) / g.depth_distance) !=
                              rounded((height(p) + 1e-12L * d.size) / g.depth_distance);
        v.doubtful |= met->nearly_corner;
        highest = rounded(height(*met) / g.depth_distance) / 16777216.0L * g.depth_distance;
        v.places[0] = moved(*met, first);
    }
    v.places[0].depth = std::max(std::sqrt(variance), highest);

    for (Place& p : v.places)
        for (const Place& other : v.places)
            if (hides(other, p)) p.behind = g.behind_cost;
    v.chosen = 0;
    for (std::size_t i = 1; i < v.places.size(); ++i)
        if (rounded(v.places[i].cost()) < rounded(v.places[std::size_t(v.chosen)].cost())) v.chosen = int(i);
    Place& winner = v.places[std::size_t(v.chosen)];
    v.misfit = winner.d2;
    v.left_over = d.left_over(winner, g.implausible_misfit);
    Real others = 0;
    bool rival = false, rival_without = false;
    for (Place& p : v.places) {
        if (&p == &winner) continue;
        const Real delta = p.cost() - winner.cost(), by_bonus = winner.prior - p.prior;
        const Real by_follow = winner.follow - p.follow;
        if (by_bonus > 0 && !v.less(g.rival_cost, delta - by_bonus)) p.why = Why::region;
        else if (by_follow > 0 && !v.less(g.rival_cost, delta - by_follow)) p.why = Why::previous;
        else if (p.behind > winner.behind && !v.less(g.rival_cost, delta)) p.why = Why::downstream;
        others += std::exp(-delta / 2);
        rival |= !v.less(g.rival_cost, delta);
        rival_without |= !v.less(g.rival_cost, p.without() - winner.without());
    }
    winner.why = Why::chosen;
    v.confidence = 1 / (1 + others);
    v.reason = rival ? Reason::ambiguous : rival_without ? Reason::by_region : winner.vertex >= 0 ? Reason::vertex : Reason::ok;
    // A region that nothing can touch is none that touches are wanted in.
    if (g.region_only && (winner.flat->region == 0 || winner.prior < 0)) {
        v.reason = Reason::outside_region;
        winner.why = Why::region;
        v.chosen = -1;
        v.confidence = 0;
    }
    return v;
}

}  // namespace testing
