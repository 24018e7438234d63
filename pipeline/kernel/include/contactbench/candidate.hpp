// From an accepted facet or vertex to a contact point, its normal and its local torque.
//
// On a facet the three edge moments are the barycentric weights of p, so p lies inside by
// construction; equivalently p = (n x M - d F) / (n . F) and k = (M . F) / (n . F), the solution of
//   p x F + k n = M,  n . p + d = 0.
// Between facets, next to a vertex, the solution can be the vertex v itself: M - v x F = k n with n
// inside the cone of normals there. Then w has one sign on every edge that leaves v. Facets and
// vertices together leave no gap: around a vertex either the sign changes, and a facet accepts, or it
// does not, and the vertex does. The vertex test reads the very signs that the facets use.
//
// Contract: results in S, m, N*m. O(1) for a facet, O(degree) for a vertex. Nothing allocates until
// more than `Hits::inline_count` candidates answer one wrench, which takes a crumpled mesh.
#pragma once

#include "model.hpp"

namespace contactbench {

enum class Why : std::uint8_t { chosen, region, friction, previous, torque, downstream, noise };

struct Candidate {
    Vec3 point, normal;    // S, m; unit, outward
    double torque = 0.0;   // k, N*m: the local torque on the probe is k * normal
    double cosine = 0.0;   // of the friction angle, between -F and the normal
    std::int32_t face = -1, vertex = -1, region = 0;
    Why why = Why::torque;
};

class Hits {
public:
    static constexpr std::size_t inline_count = 4;
    void add(const Candidate& c) {
        if (count_ < inline_count)
            first_[count_] = c;
        else
            more_.push_back(c);
        ++count_;
    }
    // Nothing allocates until more than `n` candidates answer, now and after every `clear`.
    void reserve(std::size_t n) { more_.reserve(n > inline_count ? n - inline_count : 0); }
    void clear() {
        count_ = 0;
        more_.clear();
    }
    std::size_t size() const { return count_; }
    Candidate& operator[](std::size_t i) { return i < inline_count ? first_[i] : more_[i - inline_count]; }
    const Candidate& operator[](std::size_t i) const {
        return i < inline_count ? first_[i] : more_[i - inline_count];
    }

private:
    std::array<Candidate, inline_count> first_;
    std::vector<Candidate> more_;
    std::size_t count_ = 0;
};

// Nearer to edge-on than this, whether the force pushes or pulls is rounding.
inline constexpr double least_cosine = 1e-9;

inline Candidate facet_contact(const Model& model, std::size_t slot, const double w[3], const Query& q) {
    const Triangle& t = model.tree.triangle[slot];
    const double total = w[0] + w[1] + w[2];
    const auto vertex = [&](int c) { return model.vertices[std::size_t(t[std::size_t(c)])]; };
    Candidate c;
    c.face = model.tree.face[slot];
    c.normal = model.normals[std::size_t(c.face)];
    c.region = model.region[std::size_t(c.face)];
    c.point = (w[1] / total) * vertex(0) + ((w[2] / total) * vertex(1) + (w[0] / total) * vertex(2));
    // Accepted means n . f < 0; on a facet edge-on to the force rounding can say otherwise (and the
    // caller drops it, see least_cosine).
    const double nf = std::min(dot(c.normal, q.f), -std::numeric_limits<double>::min());
    c.cosine = -nf;
    c.torque = q.force * model.frame.scale * (q.h / nf);
    return c;
}

namespace detail {

struct FanSigns {
    bool same = false, negative = false;
};

inline FanSigns fan_signs(const Model& model, std::int32_t vertex, const Query& q) {
    const auto [first, last] = model.topology.fan(vertex);
    FanSigns s;
    for (auto h = first; h != last; ++h) {
        const std::size_t slot = std::size_t(model.slot[std::size_t(*h / 3)]);
        const Triangle& t = model.tree.triangle[slot];
        const int edge = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
        const double w = edge_moment(model.tree.edges[slot], edge, q);
        const bool negative = edge_negative(edge, rises(t), w);
        if (h != first && negative != s.negative) return {};
        s.negative = negative;
    }
    s.same = first != last;
    return s;
}

inline Vec3 mean_fan_normal(const Model& model, std::int32_t vertex) {
    const auto [first, last] = model.topology.fan(vertex);
    Vec3 sum;
    for (auto h = first; h != last; ++h) sum = sum + model.normals[std::size_t(*h / 3)];
    const double length = norm(sum);
    return length > 0.0 ? (1.0 / length) * sum : model.normals[std::size_t(*first / 3)];
}

// Every edge at the vertex falls away from `up`. Does the solid lie below (true: a peak of the probe)
// or around it (false: the bottom of a pit)? The fan's outline, seen along `up`, turns left or right.
inline bool is_peak(const Model& model, std::int32_t vertex, Vec3 up) {
    const auto [first, last] = model.topology.fan(vertex);
    const Vec3 v = model.normalised[std::size_t(vertex)];
    const auto flattened = [&](std::int32_t h) {
        const Triangle& t = model.tree.triangle[std::size_t(model.slot[std::size_t(h / 3)])];
        const std::size_t c = t[0] == vertex ? 1 : t[1] == vertex ? 2 : 0;
        const Vec3 e = model.normalised[std::size_t(t[c])] - v;
        // A moment along a facet's own normal puts two edges level with `up`: keep them finite, and falling.
        return (1.0 / std::max(-dot(up, e), 1e-9 * norm(e))) * e;
    };
    Vec3 area, previous = flattened(*(last - 1));
    for (auto h = first; h != last; ++h) {
        const Vec3 e = flattened(*h);
        area = area + cross(previous, e);
        previous = e;
    }
    return dot(area, up) > 0.0;
}

}  // namespace detail

// Does the wrench press on this vertex? Fills `out` and returns true if so.
inline bool vertex_contact(const Model& model, std::int32_t vertex, const Query& q, Candidate& out) {
    const detail::FanSigns signs = detail::fan_signs(model, vertex, q);
    if (!signs.same) return false;
    const Vec3 moment = q.m - cross(model.normalised[std::size_t(vertex)], q.f);  // k n
    const double size = norm(moment);
    Vec3 n;
    if (size < 1e-13) {  // the axis runs through the vertex: any normal of the cone will do
        n = detail::mean_fan_normal(model, vertex);
    } else {
        const Vec3 up = ((signs.negative ? 1.0 : -1.0) / size) * moment;
        n = detail::is_peak(model, vertex, up) ? up : -up;
    }
    if (!(-dot(n, q.f) >= least_cosine)) return false;
    const auto [first, last] = model.topology.fan(vertex);
    out = Candidate{};
    out.vertex = vertex;
    out.face = *first / 3;
    for (auto h = first; h != last; ++h) {
        const std::int32_t face = *h / 3, rank = model.region[std::size_t(face)];
        out.face = std::min(out.face, face);
        if (rank > 0 && (out.region == 0 || rank < out.region)) out.region = rank;
    }
    out.point = model.vertices[std::size_t(vertex)];
    out.normal = n;
    out.cosine = -dot(n, q.f);
    out.torque = q.force * model.frame.scale * dot(moment, n);
    return true;
}

}  // namespace contactbench
