// Fewer facets for the same shape.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include "bindings.hpp"
#include "contactbench/collapse.hpp"

namespace contactbench::bindings {

namespace {

using Bools = nb::ndarray<const bool, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

nb::tuple collapse_edges(const Rows3& vertices, const Faces& faces, std::pair<std::int64_t, std::int64_t> wanted,
                         const Bools& second, const nb::callable& progress, const std::optional<Ints>& labels) {
    std::vector<Vec3> points = to_points(vertices);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z})
            if (!fit_for_exact(points[i].*axis) || !(std::fabs(points[i].*axis) <= 1e6))
                throw nb::value_error(("vertices: row " + std::to_string(i) + " is not within a million units").c_str());
    const std::vector<Triangle> facets = to_triangles(faces);
    refuse_missing(facets, points.size());
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const auto [a, b, c] = facets[f];
        if (!(norm2(cross(points[std::size_t(b)] - points[std::size_t(a)], points[std::size_t(c)] - points[std::size_t(a)])) > 0.0))
            throw nb::value_error(("faces: row " + std::to_string(f) + " has no area").c_str());
    }
    if (second.shape(0) != facets.size()) throw nb::value_error("second: not one per facet");
    if (wanted.first < 0 || wanted.second < 0) throw nb::value_error("wanted: less than no facets");
    const std::vector<std::uint8_t> groups(second.data(), second.data() + second.shape(0));
    std::vector<std::int32_t> kept(facets.size(), 0);
    if (labels) {
        if (labels->shape(0) != facets.size()) throw nb::value_error("labels: not one per facet");
        kept.assign(labels->data(), labels->data() + facets.size());
        if (std::any_of(kept.begin(), kept.end(), [](std::int32_t label) { return label < 0; })) throw nb::value_error("labels: one is below 0");
    }
    auto [moved, left, origin] = [&] {
        nb::gil_scoped_release release;
        return collapse_soundly(points, facets, groups, kept, {wanted.first, wanted.second}, [&](double fraction) {
            nb::gil_scoped_acquire acquire;
            progress(fraction);
        });
    }();
    std::vector<double> coordinates;
    coordinates.reserve(3 * moved.size());
    for (const Vec3& p : moved) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
    std::vector<std::int32_t> corners;
    corners.reserve(3 * left.size());
    for (const auto& t : left) corners.insert(corners.end(), t.begin(), t.end());
    return nb::make_tuple(make_array(std::move(coordinates), {moved.size(), 3}),
                          make_array(std::move(corners), {left.size(), 3}), make_array(std::move(origin), {left.size()}));
}

}  // namespace

void bind_collapse(nb::module_& m) {
    m.def("collapse_edges", &collapse_edges, nb::arg("vertices"), nb::arg("faces"), nb::arg("wanted"), nb::arg("second"),
          nb::arg("progress"), nb::arg("labels").noconvert().none() = nb::none());
}

}  // namespace contactbench::bindings
