// A way along a surface from one point on it to another: what a mouse that moved too fast has passed over.
//
// The surface is cut by the plane through both points and along the mean of their normals; that is what one sees
// as the straight line. Where the cut does not arrive (a rim, a defect, another part in between) the
// shortest way over facet centroids is taken, and where that is over `longest` chords long there is none: the
// points lie on different parts, or the line of sight jumped across an opening.
//
// Contract: O(facets on the way) for the cut. Setting up is O(m). Not for two threads at once.
#pragma once

#include <functional>

#include "geodesic.hpp"

namespace contactbench {

struct SurfacePoint {
    std::int32_t face;
    Vec3 point;
};

class PathFinder {
public:
    static constexpr double longest = 4.0;

    explicit PathFinder(const SurfaceMesh& mesh) : mesh_(&mesh), nodes_(mesh.faces.size()) {}

    // Corners of the way, both ends included; between two of them it stays in the first one's facet as far as
    // it is a cut. Empty when there is no way.
    std::vector<SurfacePoint> find(SurfacePoint from, SurfacePoint to) {
        std::vector<SurfacePoint> way;
        if (from.face == to.face) {
            way = {from, to};
            return way;
        }
        // A plane through a point on an edge or a corner may miss the facet that was picked there: then cut
        // through points that are further inside.
        for (double inwards : {0.0, 1e-3, 0.1})
            if (cut(from, to, inwards, way)) return way;
        if (!shortest(from, to, way)) way.clear();
        return way;
    }

private:
    struct Node {
        double cost = 0.0;
        std::int32_t before = -1;
        std::uint64_t run = 0;
    };

    Vec3 normal(std::int32_t f) const {
        const Vec3 n = cross(mesh_->corner(f, 1) - mesh_->corner(f, 0), mesh_->corner(f, 2) - mesh_->corner(f, 0));
        const double length = norm(n);
        return length > 0.0 ? 1.0 / length * n : Vec3{};
    }

    bool cut(SurfacePoint from, SurfacePoint to, double inwards, std::vector<SurfacePoint>& way) const {
        const Vec3 origin = from.point + inwards * (mesh_->centroid(from.face) - from.point);
        const Vec3 chord = to.point + inwards * (mesh_->centroid(to.face) - to.point) - origin;
        const Vec3 plane = cross(chord, normal(from.face) + normal(to.face));
        if (!(norm(plane) > 1e-6 * norm(chord))) return false;
        const double allowed = longest * norm(chord);
        way = {from};
        double length = 0.0;
        std::int32_t entered = -1;  // the edge, as lower and higher vertex, that must not be left by
        for (SurfacePoint here = from; here.face != to.face; way.push_back(here)) {
            const auto [half_edge, point] = exit(here.face, entered, origin, plane, chord);
            if (half_edge < 0) return false;
            length += norm(point - here.point);
            const Adjacency::Range next = mesh_->adjacency.across(half_edge);
            if (next.size() != 1 || length > allowed) return false;
            here = {*next.begin(), point};
            entered = half_edge;
            if (here.face == from.face) return false;
        }
        way.push_back(to);
        return true;
    }

    // Where the plane leaves a facet. A vertex on the plane counts as above it, so that the plane crosses
    // no edge or two edges of every facet, and the same ones seen from both sides.
    std::pair<std::int32_t, Vec3> exit(std::int32_t f, std::int32_t entered, Vec3 origin, Vec3 plane,
                                       Vec3 chord) const {
        std::pair<std::int32_t, Vec3> best{-1, {}};
        double furthest = -std::numeric_limits<double>::infinity();
        for (std::size_t c = 0; c < 3; ++c) {
            const std::int32_t a = mesh_->face(f)[c], b = mesh_->face(f)[(c + 1) % 3];
            if (entered >= 0 && same_edge(entered, a, b)) continue;
            const double da = dot(plane, mesh_->at(a) - origin), db = dot(plane, mesh_->at(b) - origin);
            if ((da >= 0.0) == (db >= 0.0)) continue;
            const Vec3 point = mesh_->at(a) + da / (da - db) * (mesh_->at(b) - mesh_->at(a));
            if (const double progress = dot(chord, point); progress > furthest) {
                furthest = progress;
                best = {std::int32_t(3 * f) + std::int32_t(c), point};
            }
        }
        return best;
    }

    bool same_edge(std::int32_t half_edge, std::int32_t a, std::int32_t b) const {
        const Triangle& t = mesh_->face(half_edge / 3);
        const std::int32_t p = t[std::size_t(half_edge % 3)], q = t[std::size_t((half_edge + 1) % 3)];
        return (p == a && q == b) || (p == b && q == a);
    }

    // A* over facets.
    bool shortest(SurfacePoint from, SurfacePoint to, std::vector<SurfacePoint>& way) {
        const double allowed = longest * norm(to.point - from.point);
        ++run_;
        heap_.clear();
        open(from.face, 0.0, -1, to.point, allowed);
        while (!heap_.empty()) {
            const auto [estimate, f] = heap_.front();
            std::pop_heap(heap_.begin(), heap_.end(), std::greater<>{});
            heap_.pop_back();
            if (f == to.face) return trace(from, to, way);
            const Vec3 here = f == from.face ? from.point : mesh_->centroid(f);
            const double cost = nodes_[std::size_t(f)].cost;
            for (std::int32_t h = 3 * f; h < 3 * f + 3; ++h)
                for (std::int32_t g : mesh_->adjacency.across(h)) {
                    const Vec3 there = g == to.face ? to.point : mesh_->centroid(g);
                    open(g, cost + norm(there - here), f, to.point, allowed);
                }
        }
        return false;
    }

    void open(std::int32_t f, double cost, std::int32_t before, Vec3 goal, double allowed) {
        Node& node = nodes_[std::size_t(f)];
        if (node.run == run_ && node.cost <= cost) return;
        const double estimate = cost + norm(goal - mesh_->centroid(f));
        if (before >= 0 && !(estimate <= allowed)) return;
        node = {cost, before, run_};
        heap_.emplace_back(estimate, f);
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>{});
    }

    bool trace(SurfacePoint from, SurfacePoint to, std::vector<SurfacePoint>& way) const {
        way = {to};
        for (std::int32_t f = nodes_[std::size_t(to.face)].before; f != from.face && f >= 0;
             f = nodes_[std::size_t(f)].before)
            way.push_back({f, mesh_->centroid(f)});
        way.push_back(from);
        std::reverse(way.begin(), way.end());
        return true;
    }

    const SurfaceMesh* mesh_;
    std::vector<Node> nodes_;
    std::vector<std::pair<double, std::int32_t>> heap_;
    std::uint64_t run_ = 0;
};

}  // namespace contactbench
