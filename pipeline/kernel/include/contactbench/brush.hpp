// A brush drawn over a surface: which facets a stroke covers, told as it grows.
//
// A facet is covered when its centroid lies within the radius of the stroke, measured along the surface or
// straight through space; and when the stroke itself runs over it, however large it is. Measured through space,
// only what hangs together with the stroke within the radius counts, so that the far side of a thin wall
// stays clean.
//
// Contract: one stroke costs O(facets covered), whatever the size of the mesh. Not for two threads at once.
#pragma once

#include "surface_path.hpp"

namespace contactbench {

class Brush {
public:
    explicit Brush(const SurfaceMesh& mesh)
        : mesh_(&mesh), field_(mesh), paths_(mesh), covered_(mesh.faces.size(), 0), visited_(mesh.faces.size(), 0) {}

    void begin(double radius, bool geodesic) {
        radius_ = radius;
        geodesic_ = geodesic;
        ++stroke_;
        sources_ = 0;
        last_.face = -1;
        field_.start(radius);
    }

    // Go on to a point inside a facet; returns the facets that this covers anew. `joined`: the way from the
    // last point belongs to the stroke.
    const std::vector<std::int32_t>& extend(SurfacePoint to, bool joined) {
        fresh_.clear();
        std::vector<SurfacePoint> way;
        if (joined && last_.face >= 0) way = paths_.find(last_, to);
        if (way.empty()) way = {to, to};
        last_ = to;
        for (const SurfacePoint& corner : way) cover(corner.face);
        place_stops(way);
        if (geodesic_) cover_along();
        else cover_straight(way);
        return fresh_;
    }

private:
    // Stops this share of the radius apart leave scallops of 0.8 % of it. Their number is bounded: a brush much
    // finer than the way is long covers little but the facets on the way, and they are covered in any case.
    static constexpr double stop_spacing = 0.25, most_stops = 4096.0;

    void cover(std::int32_t f) {
        if (covered_[std::size_t(f)] == stroke_) return;
        covered_[std::size_t(f)] = stroke_;
        fresh_.push_back(f);
    }

    void place_stops(const std::vector<SurfacePoint>& way) {
        double total = 0.0;
        for (std::size_t i = 0; i + 1 < way.size(); ++i) total += norm(way[i + 1].point - way[i].point);
        const double spacing = std::max(stop_spacing * radius_, total / most_stops);
        stops_ = {way.front()};
        double left = spacing;  // until the next stop
        for (std::size_t i = 0; i + 1 < way.size(); ++i) {
            const Vec3 step = way[i + 1].point - way[i].point;
            const double length = norm(step);
            for (; left < length; left += spacing)
                stops_.push_back({way[i].face, way[i].point + left / length * step});
            left -= length;
        }
        stops_.push_back(way.back());
    }

    void cover_along() {
        field_.forget_touched();
        for (const SurfacePoint& stop : stops_) field_.seed(stop.face, stop.point, sources_++);
        field_.run();
        field_.each_touched_facet([&](std::int32_t f) {
            if (covered_[std::size_t(f)] != stroke_ && field_.centroid_within(f, radius_)) cover(f);
        });
        // The facet that holds a stop has no corner through which its own centroid could be reached straight,
        // but it is on the way and covered already.
    }

    void cover_straight(const std::vector<SurfacePoint>& way) {
        ++extension_;
        queue_.clear();
        for (const SurfacePoint& corner : way) visit(corner.face);
        for (std::size_t i = 0; i < queue_.size(); ++i)
            for (std::int32_t h = 3 * queue_[i]; h < 3 * queue_[i] + 3; ++h)
                for (std::int32_t g : mesh_->adjacency.across(h)) {
                    if (visited_[std::size_t(g)] == extension_) continue;
                    if (within(mesh_->centroid(g))) cover(g);
                    else if (!edge_within(h)) continue;  // perhaps it is entered by another edge
                    visit(g);
                }
    }

    void visit(std::int32_t f) {
        if (visited_[std::size_t(f)] == extension_) return;
        visited_[std::size_t(f)] = extension_;
        queue_.push_back(f);
    }

    bool within(Vec3 point) const {
        for (std::size_t i = 0; i + 1 < stops_.size(); ++i)
            if (distance2(point, stops_[i].point, stops_[i + 1].point) <= radius_ * radius_) return true;
        return false;
    }

    bool edge_within(std::int32_t half_edge) const {
        const std::size_t c = std::size_t(half_edge % 3);
        const Vec3 a = mesh_->corner(half_edge / 3, c), b = mesh_->corner(half_edge / 3, c + 1);
        for (const SurfacePoint& stop : stops_)
            if (distance2(stop.point, a, b) <= radius_ * radius_) return true;
        return false;
    }

    static double distance2(Vec3 point, Vec3 a, Vec3 b) {
        const Vec3 ab = b - a, ap = point - a;
        const double length2 = norm2(ab);
        const double t = length2 > 0.0 ? std::clamp(dot(ap, ab) / length2, 0.0, 1.0) : 0.0;
        return norm2(ap - t * ab);
    }

    const SurfaceMesh* mesh_;
    DistanceField field_;
    PathFinder paths_;
    std::vector<std::uint64_t> covered_, visited_;
    std::vector<std::int32_t> fresh_, queue_;
    std::vector<SurfacePoint> stops_;
    SurfacePoint last_{-1, {}};
    std::uint64_t stroke_ = 0, extension_ = 0;
    std::int32_t sources_ = 0;
    double radius_ = 0.0;
    bool geodesic_ = true;
};

}  // namespace contactbench
