// Builds the hierarchy: orders the facets into blocks of eight and bounds every subtree.
//
// Contract: `normalised` are the vertices about Frame::centre over Frame::scale. O(n log n); allocates.
// The order depends on geometry only through comparisons, so equal input gives equal bytes.
#pragma once

#include <numeric>

#include "hierarchy.hpp"

namespace contactbench {

// What a leaf is sieved with in single precision before the exact tests: the corners of its eight
// facets, and the vertices it answers for. Every vertex with a closed fan is owned by exactly one
// leaf, one that holds a facet of its fan, so facets and vertices are found in the same descent.
struct alignas(64) Leaf {
    float corner[3][3][lanes] = {};                        // [corner][axis][lane]
    float px[lanes] = {}, py[lanes] = {}, pz[lanes] = {};  // vertices
    float ax[lanes] = {}, ay[lanes] = {}, az[lanes] = {};  // axis of the cone of the fan's normals
    float cos2_a[lanes];
    std::int32_t vertex[lanes];

    Leaf() {  // empty places never pass the cone test, whatever u
        std::fill(cos2_a, cos2_a + lanes, 4.0f);
        std::fill(vertex, vertex + lanes, -1);
    }
};

struct Hierarchy {
    std::vector<Node> nodes;          // nodes[0] is the root
    std::vector<Leaf> leaves;         // each stands for eight slots
    std::vector<FacetEdges> edges;    // by slot
    std::vector<std::int32_t> face;   // slot -> face number of the input, -1 for padding
    std::vector<Triangle> triangle;   // slot -> vertices, lowest first
};

namespace detail {

struct Cone {
    float ax = 0, ay = 0, az = 0, cos_a = 0.0f, sin_a = 1e6f;  // as built: passes every test
};

// Smallest cone about the mean direction. Wider than a half space is stored as "everything":
// cos = 0 and a huge sine make both cone tests of node_mask pass for any query.
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
            const std::vector<Vec3>& normals, const std::vector<std::int32_t>& region,
            const Topology& topology)
        : faces_(faces), points_(normalised), normals_(normals), region_(region), topology_(topology) {}

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
        own_vertices();
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
        out_.edges.resize(blocks * lanes);
        out_.face.assign(blocks * lanes, -1);
        out_.triangle.assign(blocks * lanes, Triangle{-1, -1, -1});
        for (std::size_t i = 0; i < order_.size(); ++i) {
            const std::size_t f = std::size_t(order_[i]);
            out_.face[i] = std::int32_t(f);
            out_.triangle[i] = lowest_first(faces_[f]);
            out_.edges[i] = facet_edges(out_.triangle[i], points_.data());
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec3& p = points_[std::size_t(out_.triangle[i][c])];
                auto& corner = out_.leaves[i / lanes].corner[c];
                corner[0][i % lanes] = float(p.x);
                corner[1][i % lanes] = float(p.y);
                corner[2][i % lanes] = float(p.z);
            }
        }
    }

    // Greedy: the first block around the vertex that still has a place. A block has eight and meets
    // about four new vertices; in a crowd the vertex gets a further block of its own (no facets).
    void own_vertices() {
        std::vector<std::int32_t> block_of(faces_.size());
        for (std::size_t i = 0; i < order_.size(); ++i)
            block_of[std::size_t(order_[i])] = std::int32_t(i / lanes);
        owned_.assign(out_.leaves.size(), 0);
        for (std::size_t v = 0; v < points_.size(); ++v) {
            const auto [first, last] = topology_.fan(std::int32_t(v));
            for (auto h = first; h != last; ++h)
                if (take(std::size_t(block_of[std::size_t(*h / 3)]), v)) break;
            if (first != last && !taken_) append_block(v);
            taken_ = false;
        }
    }

    bool take(std::size_t block, std::size_t vertex) {
        if (owned_[block] == lanes) return false;
        Leaf& b = out_.leaves[block];
        const int l = owned_[block]++;
        const Cone cone = bound_directions(fan_normals(std::int32_t(vertex)));
        const Vec3& p = points_[vertex];
        b.px[l] = float(p.x), b.py[l] = float(p.y), b.pz[l] = float(p.z);
        b.ax[l] = cone.ax, b.ay[l] = cone.ay, b.az[l] = cone.az;
        b.cos2_a[l] = cone.cos_a > 0.0f ? cone.cos_a * cone.cos_a : -4.0f;  // no cone: passes always
        b.vertex[l] = std::int32_t(vertex);
        return taken_ = true;
    }

    void append_block(std::size_t vertex) {
        out_.leaves.emplace_back();
        out_.edges.resize(out_.leaves.size() * lanes);
        owned_.push_back(0);
        out_.face.insert(out_.face.end(), lanes, -1);
        out_.triangle.insert(out_.triangle.end(), lanes, Triangle{-1, -1, -1});
        take(out_.leaves.size() - 1, vertex);
    }

    std::vector<Vec3> fan_normals(std::int32_t vertex) const {
        const auto [first, last] = topology_.fan(vertex);
        std::vector<Vec3> normals;
        for (auto h = first; h != last; ++h) normals.push_back(normals_[std::size_t(*h / 3)]);
        return normals;
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
        std::int32_t rank = std::numeric_limits<std::int32_t>::max();
        const auto include = [&](const Vec3& p) {
            lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
            hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
        };
        for (std::size_t i = blocks.first * lanes; i < blocks.second * lanes; ++i) {
            if (out_.face[i] < 0) continue;
            for (std::int32_t v : out_.triangle[i]) include(points_[std::size_t(v)]);
            normals.push_back(normals_[std::size_t(out_.face[i])]);
            const std::int32_t region = region_[std::size_t(out_.face[i])];
            if (region > 0) rank = std::min(rank, region);
        }
        for (std::size_t b = blocks.first; b < blocks.second; ++b)
            for (std::int32_t v : out_.leaves[b].vertex) {
                if (v < 0) continue;
                include(points_[std::size_t(v)]);
                for (const Vec3& n : fan_normals(v)) normals.push_back(n);
            }
        Node& n = out_.nodes[node];
        n.cx[lane] = float(0.5 * (lo.x + hi.x));
        n.cy[lane] = float(0.5 * (lo.y + hi.y));
        n.cz[lane] = float(0.5 * (lo.z + hi.z));
        n.ex[lane] = half_extent(lo.x, hi.x, n.cx[lane]);
        n.ey[lane] = half_extent(lo.y, hi.y, n.cy[lane]);
        n.ez[lane] = half_extent(lo.z, hi.z, n.cz[lane]);
        n.rank[lane] = float(rank);
        const Cone cone = bound_directions(normals);
        n.ax[lane] = cone.ax, n.ay[lane] = cone.ay, n.az[lane] = cone.az;
        n.cos_a[lane] = cone.cos_a, n.cos2_a[lane] = cone.cos_a * cone.cos_a, n.sin_a[lane] = cone.sin_a;
        n.radius[lane] = half_extent(0.0, std::hypot(n.ex[lane], n.ey[lane], n.ez[lane]), 0.0f);
    }

    const std::vector<Triangle>& faces_;
    const std::vector<Vec3>& points_;
    const std::vector<Vec3>& normals_;
    const std::vector<std::int32_t>& region_;
    const Topology& topology_;
    std::vector<std::int32_t> order_, owned_;
    std::vector<Vec3> centroid_;
    Hierarchy out_;
    bool taken_ = false;
};

}  // namespace detail
}  // namespace contactbench
