// Builds the hierarchy: orders the facets into blocks of eight and bounds every subtree.
//
// Contract: `normalised` are the vertices about Frame::centre over Frame::scale. O(n log n); allocates.
// The order depends on geometry only through comparisons, so equal input gives equal bytes.
#pragma once

#include <numeric>

#include "hierarchy.hpp"

namespace contactbench {

// Eight facets in single precision: what is looked at before a facet in full.
struct alignas(64) Leaf {
    float corner[3][3][lanes] = {};  // [corner][axis][lane]
    float normal[3][lanes] = {};
    float spread[lanes] = {}, bend[lanes] = {}, bonus[lanes] = {};
};

// One facet in full: normalised corners, the lowest vertex number first, winding kept.
struct Facet {
    Vec3 corner[3], normal;
    MeshError<double> error;
    double bonus = 0.0;  // 2 ln(odds) of a touch here
};

struct Hierarchy {
    std::vector<Node> nodes;         // nodes[0] is the root
    std::vector<Leaf> leaves;        // each stands for eight slots
    std::vector<Facet> facets;       // by slot
    std::vector<std::int32_t> face;  // slot -> face number of the input, -1 for padding
    std::vector<Triangle> triangle;  // slot -> vertices, lowest first
};

// The facet with its lowest vertex number first, winding kept.
inline Triangle lowest_first(const Triangle& t) {
    const std::size_t i = std::size_t(std::min_element(t.begin(), t.end()) - t.begin());
    return {t[i], t[(i + 1) % 3], t[(i + 2) % 3]};
}

namespace detail {

struct Cone {
    float ax = 0, ay = 0, az = 0, cos_a = 0.0f, sin_a = 1e6f;  // as built: passes every test
};

// Smallest cone about the mean direction. Wider than a half space is stored as "everything":
// a huge sine says so to node_bound.
inline Cone bound_directions(const std::vector<Vec3>& normals) {
    Vec3 sum;
    for (const Vec3& n : normals) sum = sum + n;
    Cone cone;
    const double length = norm(sum);
    if (!(length > 1e-9)) return cone;
    cone.ax = float(sum.x / length), cone.ay = float(sum.y / length), cone.az = float(sum.z / length);
    const Vec3 axis{cone.ax, cone.ay, cone.az};  // bound about the axis as stored, not as meant
    double c = 1.0;
    for (const Vec3& n : normals) c = std::min(c, dot(n, axis) / norm(axis));
    c -= 1e-6;
    if (c <= 0.0) return Cone{};
    cone.cos_a = float(c), cone.sin_a = float(std::sqrt(1.0 - c * c) + 1e-6);
    return cone;
}

inline float half_extent(double lo, double hi, float centre) {
    const double e = std::max(hi - double(centre), double(centre) - lo);
    return std::nextafter(float(e * (1.0 + 1e-6)), std::numeric_limits<float>::max());
}

class Builder {
public:
    Builder(const std::vector<Triangle>& faces, const std::vector<Vec3>& normalised,
            const std::vector<Vec3>& normals, const std::vector<MeshError<double>>& errors,
            const std::vector<double>& bonus)
        : faces_(faces), points_(normalised), normals_(normals), errors_(errors), bonus_(bonus) {}

    Hierarchy build() {
        const std::size_t n = faces_.size();
        order_.resize(n);
        std::iota(order_.begin(), order_.end(), 0);
        centroid_.resize(n);
        for (std::size_t f = 0; f < n; ++f)
            centroid_[f] = (1.0 / 3.0) * (points_[std::size_t(faces_[f][0])] +
                                          points_[std::size_t(faces_[f][1])] +
                                          points_[std::size_t(faces_[f][2])]);
        sort_range(0, n, child_capacity((n + lanes - 1) / lanes));
        fill_blocks();
        out_.nodes.emplace_back();
        make_node(0, 0, out_.leaves.size());
        return std::move(out_);
    }

private:
    using Range = std::pair<std::size_t, std::size_t>;

    // How many blocks each child of a node over `blocks` blocks gets: a power of eight, so that all
    // nodes are full but those on the right edge and the root.
    static std::size_t child_capacity(std::size_t blocks) {
        std::size_t capacity = 1;
        while (capacity * lanes < blocks) capacity *= lanes;
        return capacity;
    }

    // Where to halve `blocks` blocks so that both halves are made of whole children.
    static std::size_t middle(std::size_t blocks, std::size_t capacity) {
        return capacity * (((blocks + capacity - 1) / capacity + 1) / 2);
    }

    void sort_range(std::size_t lo, std::size_t hi, std::size_t capacity) {
        const std::size_t blocks = (hi - lo + lanes - 1) / lanes;
        if (blocks <= 1) return;
        if (blocks <= capacity) return sort_range(lo, hi, child_capacity(blocks));
        const std::size_t mid = lo + lanes * middle(blocks, capacity);
        halve(lo, mid, hi);
        sort_range(lo, mid, capacity);
        sort_range(mid, hi, capacity);
    }

    // Across the longest side of the centroids' box.
    void halve(std::size_t lo, std::size_t mid, std::size_t hi) {
        Vec3 least = centroid_[std::size_t(order_[lo])], most = least;
        for (std::size_t i = lo; i < hi; ++i) {
            const Vec3& c = centroid_[std::size_t(order_[i])];
            least = {std::min(least.x, c.x), std::min(least.y, c.y), std::min(least.z, c.z)};
            most = {std::max(most.x, c.x), std::max(most.y, c.y), std::max(most.z, c.z)};
        }
        const Vec3 d = most - least;
        double Vec3::*axis = d.x >= d.y && d.x >= d.z ? &Vec3::x : d.y >= d.z ? &Vec3::y : &Vec3::z;
        const auto at = [&](std::size_t i) { return order_.begin() + std::ptrdiff_t(i); };
        std::nth_element(at(lo), at(mid), at(hi), [&](std::int32_t a, std::int32_t b) {
            const double p = centroid_[std::size_t(a)].*axis, q = centroid_[std::size_t(b)].*axis;
            return p != q ? p < q : a < b;
        });
    }

    void fill_blocks() {
        const std::size_t blocks = (order_.size() + lanes - 1) / lanes;
        out_.leaves.resize(blocks);
        out_.facets.resize(blocks * lanes);
        out_.face.assign(blocks * lanes, -1);
        out_.triangle.assign(blocks * lanes, Triangle{-1, -1, -1});
        for (std::size_t i = 0; i < order_.size(); ++i) {
            const std::size_t f = std::size_t(order_[i]), l = i % lanes;
            out_.face[i] = std::int32_t(f);
            out_.triangle[i] = lowest_first(faces_[f]);
            Facet& facet = out_.facets[i];
            Leaf& leaf = out_.leaves[i / lanes];
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec3& p = facet.corner[c] = points_[std::size_t(out_.triangle[i][c])];
                leaf.corner[c][0][l] = float(p.x), leaf.corner[c][1][l] = float(p.y), leaf.corner[c][2][l] = float(p.z);
            }
            const Vec3& n = facet.normal = normals_[f];
            leaf.normal[0][l] = float(n.x), leaf.normal[1][l] = float(n.y), leaf.normal[2][l] = float(n.z);
            facet.error = errors_[f];
            facet.bonus = bonus_[f];
            leaf.spread[l] = float(facet.error.spread), leaf.bend[l] = float(facet.error.bend);
            leaf.bonus[l] = float(facet.bonus);
        }
    }

    static void split(Range r, std::size_t capacity, std::vector<Range>& parts) {
        const std::size_t blocks = r.second - r.first;
        if (blocks <= capacity) return parts.push_back(r);
        const std::size_t mid = r.first + middle(blocks, capacity);
        split({r.first, mid}, capacity, parts);
        split({mid, r.second}, capacity, parts);
    }

    void make_node(std::size_t node, std::size_t first, std::size_t last) {
        std::vector<Range> parts;
        split({first, last}, child_capacity(last - first), parts);
        std::fill(out_.nodes[node].child, out_.nodes[node].child + lanes, empty_child);
        for (std::size_t l = 0; l < parts.size(); ++l) {
            bound_lane(node, int(l), parts[l]);
            if (parts[l].second - parts[l].first == 1) {
                out_.nodes[node].child[l] = ~std::int32_t(parts[l].first);
                continue;
            }
            const std::size_t child = out_.nodes.size();
            out_.nodes.emplace_back();
            out_.nodes[node].child[l] = std::int32_t(child);
            make_node(child, parts[l].first, parts[l].second);
        }
    }

    void bound_lane(std::size_t node, int lane, Range blocks) {
        constexpr double inf = std::numeric_limits<double>::infinity();
        Vec3 lo{inf, inf, inf}, hi{-inf, -inf, -inf};
        std::vector<Vec3> normals;
        double spread = 0.0, bend = 0.0, bonus = -inf;
        for (std::size_t i = blocks.first * lanes; i < blocks.second * lanes; ++i) {
            if (out_.face[i] < 0) continue;
            const Facet& f = out_.facets[i];
            for (const Vec3& p : f.corner) {
                lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
                hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
            }
            normals.push_back(f.normal);
            spread = std::max(spread, f.error.spread), bend = std::max(bend, f.error.bend);
            bonus = std::max(bonus, f.bonus);
        }
        Node& n = out_.nodes[node];
        n.cx[lane] = float(0.5 * (lo.x + hi.x));
        n.cy[lane] = float(0.5 * (lo.y + hi.y));
        n.cz[lane] = float(0.5 * (lo.z + hi.z));
        n.ex[lane] = half_extent(lo.x, hi.x, n.cx[lane]);
        n.ey[lane] = half_extent(lo.y, hi.y, n.cy[lane]);
        n.ez[lane] = half_extent(lo.z, hi.z, n.cz[lane]);
        const Cone cone = bound_directions(normals);
        n.ax[lane] = cone.ax, n.ay[lane] = cone.ay, n.az[lane] = cone.az;
        n.cos_a[lane] = cone.cos_a, n.sin_a[lane] = cone.sin_a;
        n.spread[lane] = float(spread * (1.0 + 1e-6)), n.bend[lane] = float(bend * (1.0 + 1e-6));
        n.bonus[lane] = float(bonus + 1e-6 * std::fabs(bonus));
    }

    const std::vector<Triangle>& faces_;
    const std::vector<Vec3>& points_;
    const std::vector<Vec3>& normals_;
    const std::vector<MeshError<double>>& errors_;
    const std::vector<double>& bonus_;
    std::vector<std::int32_t> order_;
    std::vector<Vec3> centroid_;
    Hierarchy out_;
};

}  // namespace detail
}  // namespace contactbench
