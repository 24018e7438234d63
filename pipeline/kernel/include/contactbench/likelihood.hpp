// How well a touch at one place explains a wrench: d2, in standard deviations squared.
//
// A touch at p with outward normal n, force F and torsion k obeys M - p x F = k n. Measured, F and M are off by e_F
// and e_M, k is unknown but small, and the mesh is not quite the surface. So r(p) = M - p x F is Gaussian about 0 with
//   S(p) = A C A^T + (l |F|)^2 n n^T + mesh,   A = [-[p]x | 1],   d2(p) = r^T S^-1 r
// where C is the covariance of the wrench and l the torsion arm. l -> infinity is the closed form p x F + k n = M
// (d2 = 0 on every facet that holds a solution), l -> 0 the wrench axis.
//
// In the frame (f, a, b) with f along the force, r = (h, w): h, the pitch, is the same for every p, and w is p's offset
// from the axis, turned by a right angle. Given h, w is Gaussian about w* with covariance V, so on a facet
//   d2 = h^2 / S_ff + (distance of w* from the triangle of its corners' w, in the metric V)^2.
// Nothing is iterated and nothing is solved but a 2x2 system.
//
// log det S is left out of the ranking: integrated over the surface, |S|^-1/2 times the area that explains the wrench
// does not depend on S's part across the force, so it would only favour what is near the sensor.
//
// Contract
//   units    S-frame metres, N, N*m outside; inside, lengths are over `Frame::scale` about `Frame::centre` and the
//            wrench over its force, so every number is of order one for a mesh of any size and place.
//   S(p)     is taken at the depth where the axis meets the facet's plane, no further than the facet reaches.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "pack.hpp"
#include "vec.hpp"

namespace contactbench {

struct Frame {
    Vec3 centre;
    double scale = 1.0;
};

// Of (F, M) about the sensor origin, N^2, N^2*m, N^2*m^2, force before torque: sensor noise after its filter, what the
// calibration leaves, and what the model does not know (drift, cable, hysteresis).
struct WrenchCovariance {
    double s[6][6] = {};
};

// Coefficients of 1, t, t^2.
template <class S>
struct InDepth {
    S c[3] = {};

    template <class R>
    CONTACTBENCH_INLINE R at(R t) const {
        return c[0] + t * (c[1] + t * c[2]);
    }

    // How large the terms are that `at` adds, whatever is left of them, |t| given.
    template <class R>
    CONTACTBENCH_INLINE R terms(R t) const {
        return magnitude(c[0]) + t * (magnitude(c[1]) + t * magnitude(c[2]));
    }
};

// What a facet is judged by; eight facets by one of eight lanes, all alike.
template <class S>
struct Form {
    S h{}, ma{}, mb{};  // pitch m . f, and m . a, m . b
    S arm2{};           // torsion arm, squared
    // Covariance of r by depth t = p . f; that of r . f does not change along the axis.
    S ff{};
    InDepth<S> fa, fb, aa, ab, bb;
    S f[3] = {}, a[3] = {}, b[3] = {};  // right-handed
    S foot[3] = {};                     // of the axis: nearest to the mesh centre
};

// A wrench, made dimensionless: f = F/|F|, m its moment about the mesh centre over |F| and the scale.
struct Query {
    Vec3 f, m, a, b;
    double force = 0.0;  // |F|, N
    Form<double> form;
};

// In single precision and in every lane.
inline Form<Float8> in_lanes(const Form<double>& d) {
    Form<Float8> s;
    const auto all = [](double x) { return Float8{} + float(x); };
    const auto three = [&](const double(&from)[3], Float8(&to)[3]) {
        for (int i = 0; i < 3; ++i) to[i] = all(from[i]);
    };
    s.h = all(d.h), s.ma = all(d.ma), s.mb = all(d.mb), s.arm2 = all(d.arm2), s.ff = all(d.ff);
    three(d.fa.c, s.fa.c), three(d.fb.c, s.fb.c), three(d.aa.c, s.aa.c), three(d.ab.c, s.ab.c), three(d.bb.c, s.bb.c);
    three(d.f, s.f), three(d.a, s.a), three(d.b, s.b), three(d.foot, s.foot);
    return s;
}

namespace detail {

// Adds nothing that a double could tell from noise, and keeps S regular where somebody states no noise at all.
inline constexpr double least_variance = 1e-12;

struct Vec6 {
    Vec3 F, M;
};

inline double dot(const Vec6& x, const Vec6& y) { return contactbench::dot(x.F, y.F) + contactbench::dot(x.M, y.M); }

// C about the mesh centre: M_c = M - centre x F.
inline WrenchCovariance about(const WrenchCovariance& c, Vec3 p) {
    const double X[3][3] = {{0, -p.z, p.y}, {p.z, 0, -p.x}, {-p.y, p.x, 0}};
    WrenchCovariance half = c, out;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 6; ++j)
            half.s[3 + i][j] += -X[i][0] * c.s[0][j] + -X[i][1] * c.s[1][j] + -X[i][2] * c.s[2][j];
    out = half;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 3; ++j)
            out.s[i][3 + j] += half.s[i][0] * -X[j][0] + half.s[i][1] * -X[j][1] + half.s[i][2] * -X[j][2];
    return out;
}

inline Vec6 times(const WrenchCovariance& c, const Vec6& x) {
    const double v[6] = {x.F.x, x.F.y, x.F.z, x.M.x, x.M.y, x.M.z};
    double out[6] = {};
    for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 6; ++i) out[i] += c.s[j][i] * v[j];
    return {{out[0], out[1], out[2]}, {out[3], out[4], out[5]}};
}

}  // namespace detail

// What a query is made with: the covariance about the mesh centre, in units of `frame`.
struct Uncertainty {
    WrenchCovariance wrench;   // as given, about the sensor origin, SI
    WrenchCovariance centred;  // about the mesh centre, torques over the scale

    Uncertainty() = default;
    Uncertainty(const WrenchCovariance& c, const Frame& frame) : wrench(c) {
        centred = detail::about(c, frame.centre);
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) {
                if (i >= 3) centred.s[i][j] /= frame.scale;
                if (j >= 3) centred.s[i][j] /= frame.scale;
            }
    }
};

// Without a torsion arm. Precondition: the wrench is finite and |F| > 0.
inline Query make_query(const Frame& frame, const Wrench& wrench, const Uncertainty& u) {
    Query q;
    q.force = norm(wrench.F);
    q.f = (1.0 / q.force) * wrench.F;
    q.m = (1.0 / (q.force * frame.scale)) * (wrench.M - cross(frame.centre, wrench.F));
    // Duff et al. 2017: a basis without a branch that could jump but at f.z = 0.
    const double sign = std::copysign(1.0, q.f.z), s = -1.0 / (sign + q.f.z), xy = q.f.x * q.f.y * s;
    q.a = {1.0 + sign * q.f.x * q.f.x * s, sign * xy, -sign * q.f.x};
    q.b = {xy, sign + q.f.y * q.f.y * s, -q.f.y};
    Form<double>& o = q.form;
    o.h = dot(q.m, q.f), o.ma = dot(q.m, q.a), o.mb = dot(q.m, q.b);
    const Vec3 foot = cross(q.f, q.m);
    const auto three = [](Vec3 v, double(&to)[3]) { to[0] = v.x, to[1] = v.y, to[2] = v.z; };
    three(q.f, o.f), three(q.a, o.a), three(q.b, o.b), three(foot, o.foot);
    // Far from the mesh the wrench's errors are those at its border: that is where a touch would be.
    const double away = norm(foot);
    const Vec3 at = away > 1.75 ? (1.75 / away) * foot : foot;
    // r . u is off by e_M . u + e_F . (p x u), and p x a = foot x a + t b, p x b = foot x b - t a.
    using detail::Vec6;
    const Vec6 gf{cross(at, q.f), q.f}, ga{cross(at, q.a), q.a}, gb{cross(at, q.b), q.b}, ta{q.b, {}}, tb{-q.a, {}};
    const auto C = [&](const Vec6& x) { return detail::times(u.centred, x); };
    const Vec6 Cf = C(gf), Ca = C(ga), Cb = C(gb), Cta = C(ta), Ctb = C(tb);
    const double unit = 1.0 / (q.force * q.force), least = detail::least_variance;
    using detail::dot;
    o.ff = unit * dot(gf, Cf) + least;
    o.fa = {{unit * dot(ga, Cf), unit * dot(ta, Cf), 0.0}};
    o.fb = {{unit * dot(gb, Cf), unit * dot(tb, Cf), 0.0}};
    o.aa = {{unit * dot(ga, Ca) + least, 2.0 * unit * dot(ga, Cta), unit * dot(ta, Cta)}};
    o.ab = {{unit * dot(ga, Cb), unit * (dot(ga, Ctb) + dot(gb, Cta)), unit * dot(ta, Ctb)}};
    o.bb = {{unit * dot(gb, Cb) + least, 2.0 * unit * dot(gb, Ctb), unit * dot(tb, Ctb)}};
    return q;
}

inline void set_arm(const Frame& frame, double arm, Query& q) {
    arm /= frame.scale;
    q.form.arm2 = arm * arm;
}

// What the mesh leaves open at a facet: variance of the surface along the normal (mesh scales squared), and of the
// normal about either tangent (rad^2).
template <class R>
struct MeshError {
    R spread{}, bend{};
};

// The Gaussian of w given h on a facet's plane.
template <class R>
struct Conditional {
    R pitch2{};          // h^2 / S_ff
    R wa{}, wb{};        // w*
    R aa{}, ab{}, bb{};  // V
    R kappa{}, ka{}, kb{};  // torsion over |F| and scale: its mean at w*, and how it changes with V^-1 (w - w*)
};

template <class R, class S>
CONTACTBENCH_INLINE Conditional<R> condition(const Form<S>& q, R cosine, R na, R nb, R depth, const MeshError<R>& e) {
    Conditional<R> g;
    const R c = larger(cosine, R{} + typename Scalar<R>::type(1e-6)), c2 = c * c;
    // A normal that is off by d turns k n by k d, k = h / c. Along f that would excuse a torsion that is too large.
    const R turned = e.bend * (q.h * q.h) / c2;
    const S per_ff = 1.0f / q.ff;
    const R fa = q.fa.at(depth), fb = q.fb.at(depth);
    const R ga = fa * per_ff, gb = fb * per_ff, ua = na + ga * c, ub = nb + gb * c;
    const R per_total = 1.0f / (q.ff + q.arm2 * c2), var = q.arm2 * q.ff * per_total;
    g.pitch2 = (q.h * q.h) * per_total;
    g.kappa = -(q.arm2 * q.h) * c * per_total;
    g.ka = var * ua, g.kb = var * ub;
    g.wa = ga * q.h + ua * g.kappa, g.wb = gb * q.h + ub * g.kappa;
    g.aa = q.aa.at(depth) + turned + e.spread * nb * nb - fa * ga + g.ka * ua;
    g.ab = q.ab.at(depth) - e.spread * na * nb - fa * gb + g.ka * ub;
    g.bb = q.bb.at(depth) + turned + e.spread * na * na - fb * gb + g.kb * ub;
    return g;
}

// The best touch on a facet.
struct FacetFit {
    double cosine = 0.0;
    double d2 = 0.0;
    double weight[3] = {};  // barycentric; exactly 1 on a corner
    double torsion = 0.0;   // over |F| and scale
};

// `p` corners, counter-clockwise from outside; `n` their unit normal.
inline FacetFit fit_facet(const Vec3 (&p)[3], Vec3 n, const MeshError<double>& e, const Query& q) {
    FacetFit fit;
    fit.cosine = -dot(n, q.f);
    double depth[3];
    for (int i = 0; i < 3; ++i) depth[i] = dot(p[i], q.f);
    const Form<double>& o = q.form;
    const double met = (dot(n, {o.foot[0], o.foot[1], o.foot[2]}) - dot(n, p[0])) / std::max(fit.cosine, 1e-6);
    const double nearest = std::min({depth[0], depth[1], depth[2]}), farthest = std::max({depth[0], depth[1], depth[2]});
    const Conditional<double> g = condition(o, fit.cosine, dot(n, q.a), dot(n, q.b),
                                            std::min(std::max(met, nearest), farthest), e);
    // In the metric of V = L L^T, w* at the origin.
    const double l11 = std::sqrt(g.aa), i11 = 1.0 / l11, l21 = g.ab * i11;
    const double i22 = 1.0 / std::sqrt(std::max(g.bb - l21 * l21, 1e-12 * g.bb));
    double x[3], y[3];
    for (int i = 0; i < 3; ++i) {
        x[i] = (o.ma - dot(p[i], q.b) - g.wa) * i11;
        y[i] = (o.mb + dot(p[i], q.a) - g.wb - l21 * x[i]) * i22;
    }
    // Along the force a facet that is pushed runs clockwise.
    const double c0 = x[2] * y[1] - x[1] * y[2], c1 = x[0] * y[2] - x[2] * y[0], c2 = x[1] * y[0] - x[0] * y[1];
    double bx = 0.0, by = 0.0, miss2 = 0.0;
    if (c0 >= 0.0 && c1 >= 0.0 && c2 >= 0.0 && c0 + c1 + c2 > 0.0) {
        const double share = 1.0 / (c0 + c1 + c2);
        fit.weight[0] = c0 * share, fit.weight[1] = c1 * share, fit.weight[2] = c2 * share;
    } else {
        miss2 = HUGE_VAL;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            const double ex = x[j] - x[i], ey = y[j] - y[i], size = ex * ex + ey * ey;
            const double s = size > 0.0 ? std::min(std::max(-(x[i] * ex + y[i] * ey) / size, 0.0), 1.0) : 0.0;
            const double px = x[i] + s * ex, py = y[i] + s * ey, d = px * px + py * py;
            if (!(d < miss2)) continue;
            miss2 = d, bx = px, by = py;
            fit.weight[i] = 1.0 - s, fit.weight[j] = s, fit.weight[3 - i - j] = 0.0;
        }
    }
    fit.d2 = g.pitch2 + miss2;
    // u^T V^-1 (w - w*) = (L^-1 u) . z
    const double tx = g.ka * i11, ty = (g.kb - l21 * tx) * i22;
    fit.torsion = g.kappa + tx * bx + ty * by;
    return fit;
}

// Lower bounds of d2 in eight places, and what they were made of.
inline constexpr float no_touch = 1e38f;
struct Bounds {
    Float8 d2;              // no_touch: no normal is inside the friction cone
    Float8 wa, wb, near;  // w* is no further from here than this
    Float8 V;             // its largest eigenvalue, or more
};

// Eight facets, and the w of their corners.
struct Facets {
    Float8 p[3][3], n[3];  // [corner][axis]
    Float8 cosine, wa[3], wb[3];
};

CONTACTBENCH_INLINE Float8 along(const Float8 (&v)[3], const Float8 (&d)[3]) { return v[0] * d[0] + v[1] * d[1] + v[2] * d[2]; }

// Of eight facets, in single precision: the distance of w* from the furthest of the lines along a triangle's edges that
// it lies beyond, or along the one that tells the most. `margin`: four times how far rounding may move w; `loose`: what
// it may take from V. Where all are beyond `most`, the first bound that says so.
CONTACTBENCH_INLINE Bounds bound_facets(const Facets& facets, const MeshError<Float8>& e, const Form<Float8>& q,
                                        const Float8& cos_friction, Float8 margin, Float8 loose, float most) {
    const Float8(&p)[3][3] = facets.p, (&n)[3] = facets.n, cosine = facets.cosine;
    const Float8 d0 = along(p[0], q.f), d1 = along(p[1], q.f), d2 = along(p[2], q.f);
    const Float8 plane = n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2];
    const Float8 met = (along(n, q.foot) - plane) / larger(cosine, Float8{} + 1e-6f);
    const Float8 depth = smaller(larger(met, smaller(smaller(d0, d1), d2)), larger(larger(d0, d1), d2));
    Conditional<Float8> g = condition(q, cosine, along(n, q.a), along(n, q.b), depth, e);
    g.aa += loose, g.bb += loose;
    Bounds bounds;
    bounds.wa = g.wa, bounds.wb = g.wb, bounds.near = margin;
    const Float8 half = 0.5f * (g.aa - g.bb);
    bounds.V = 0.5f * (g.aa + g.bb) + root(half * half + g.ab * g.ab);
    const auto set = [&](const Float8& miss2) {
        bounds.d2 = select(cosine >= cos_friction - margin, (g.pitch2 + miss2) * (1.0f - 2e-3f), Float8{} + no_touch);
    };
    Float8 x[3], y[3];
    for (int i = 0; i < 3; ++i) x[i] = facets.wa[i] - g.wa, y[i] = facets.wb[i] - g.wb;
    // Along any direction u the miss counts against u' V u alone; V^-1 times the miss of the middle is about the best.
    const Float8 mx = x[0] + x[1] + x[2], my = y[0] + y[1] + y[2];
    const Float8 scale = 1.0f / (g.aa + g.bb), ua = (g.bb * mx - g.ab * my) * scale, ub = (g.aa * my - g.ab * mx) * scale;
    const Float8 nearest = smaller(smaller(ua * x[0] + ub * y[0], ua * x[1] + ub * y[1]), ua * x[2] + ub * y[2]);
    const Float8 gap = larger(nearest - margin * (magnitude(ua) + magnitude(ub)), Float8{});
    const Float8 uaa = ua * ua * g.aa, ubb = ub * ub * g.bb, uab = 2.0f * ua * ub * g.ab;
    const Float8 against = uaa + ubb + uab + 1e-5f * (uaa + ubb + magnitude(uab));
    Float8 miss2 = gap * gap / larger(against, Float8{} + 1e-30f);
    set(miss2);
    if (mask_of(bounds.d2 <= most) == 0) return bounds;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const Float8 ex = x[j] - x[i], ey = y[j] - y[i];
        // Beyond a clockwise edge the origin lies on its left. Rounding moves the corners, and turns a short edge:
        // guarded by the slivers of the tests.
        const Float8 size = magnitude(ex) + magnitude(ey), away = magnitude(x[i]) + magnitude(y[i]);
        const Float8 beyond = larger(x[i] * ey - ex * y[i] - margin * (size + 0.5f * away), Float8{});
        const Float8 spread = ey * ey * g.aa - 2.0f * ex * ey * g.ab + ex * ex * g.bb + margin * (size + margin) * (g.aa + g.bb);
        miss2 = larger(miss2, beyond * beyond / larger(spread, Float8{} + 1e-30f));
    }
    set(miss2);
    return bounds;
}

// Covariance of the touch along the facet's plane, S, m^2, rank 2: what V leaves of p.
inline Mat3 plane_covariance(const Frame& frame, const Query& q, Vec3 n, double depth, const MeshError<double>& e) {
    const double na = dot(n, q.a), nb = dot(n, q.b), nf = dot(n, q.f);
    const Conditional<double> g = condition(q.form, -nf, na, nb, depth, e);
    const double push = std::fabs(nf) > 1e-9 ? nf : -1e-9;
    // dw = (-b . dp, a . dp), and n . dp = 0.
    const Vec3 A = (nb / push) * q.f - q.b, B = q.a - (na / push) * q.f;
    const double s2 = frame.scale * frame.scale;
    const double a[3] = {A.x, A.y, A.z}, b[3] = {B.x, B.y, B.z};
    Mat3 out;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            out.m[i][j] = s2 * (g.aa * a[i] * a[j] + g.ab * (a[i] * b[j] + b[i] * a[j]) + g.bb * b[i] * b[j]);
    return out;
}

// The largest standard deviation of w on a facet's plane, m: of the touch, seen along the force.
inline double sigma_across(const Frame& frame, const Query& q, Vec3 n, double depth, const MeshError<double>& e) {
    const Conditional<double> g = condition(q.form, -dot(n, q.f), dot(n, q.a), dot(n, q.b), depth, e);
    const double half = 0.5 * (g.aa - g.bb);
    return frame.scale * std::sqrt(0.5 * (g.aa + g.bb) + std::sqrt(half * half + g.ab * g.ab));
}

// Half axes (one standard deviation, as vectors in the tangent plane) of a rank-2 covariance, longest first.
inline std::array<Vec3, 2> ellipse_axes(const Mat3& s, Vec3 n) {
    const Vec3 seed = std::fabs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    Vec3 a = cross(n, seed);
    a = (1.0 / norm(a)) * a;
    const Vec3 b = cross(n, a);
    const auto apply = [&](Vec3 v) {
        return Vec3{s.m[0][0] * v.x + s.m[0][1] * v.y + s.m[0][2] * v.z,
                    s.m[1][0] * v.x + s.m[1][1] * v.y + s.m[1][2] * v.z,
                    s.m[2][0] * v.x + s.m[2][1] * v.y + s.m[2][2] * v.z};
    };
    const double aa = dot(a, apply(a)), ab = dot(a, apply(b)), bb = dot(b, apply(b));
    const double turn = 0.5 * std::atan2(2.0 * ab, aa - bb);
    const double mean = 0.5 * (aa + bb), half = std::hypot(0.5 * (aa - bb), ab);
    const Vec3 major = std::cos(turn) * a + std::sin(turn) * b;
    const double large = std::sqrt(std::max(0.0, mean + half)), small = std::sqrt(std::max(0.0, mean - half));
    return {large * major, small * cross(n, major)};
}

// The largest standard deviation of a point, m, whatever its direction.
inline double largest_sigma(const Mat3& s) { return std::sqrt(largest_eigenvalue(s)); }

// The 95 % ellipse of a point reaches so many standard deviations: sqrt(-2 ln 0.05).
inline constexpr double sigmas_of_95 = 2.4477468306808161;

}  // namespace contactbench
