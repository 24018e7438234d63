// Distances along the surface, ways on it, and brush strokes.
#include <mutex>

#include "bindings.hpp"
#include "contactbench/brush.hpp"

namespace contactbench::bindings {

namespace {

// The stroke has scratch of its own: a distance asked for in between does not disturb it.
struct Geodesic {
    SurfaceMesh mesh;
    DistanceField field;
    PathFinder paths;
    Brush brush;
    bool drawing = false;
    std::mutex busy;

    Geodesic(std::vector<Vec3> vertices, std::vector<Triangle> faces)
        : mesh(std::move(vertices), std::move(faces)), field(mesh), paths(mesh), brush(mesh) {}
};

void construct(Geodesic* self, Rows3 vertices, Faces faces) {
    std::vector<Vec3> points(vertices.shape(0));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double* p = vertices.data() + 3 * i;
        points[i] = {p[0], p[1], p[2]};
        if (!finite(points[i])) throw nb::value_error("vertices must be finite");
    }
    std::vector<Triangle> triangles(faces.shape(0));
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const std::int32_t* t = faces.data() + 3 * i;
        triangles[i] = {t[0], t[1], t[2]};
    }
    const nb::gil_scoped_release release;
    new (self) Geodesic(std::move(points), std::move(triangles));
}

SurfacePoint surface_point(const Geodesic& g, std::int64_t face, Vector3 point) {
    if (face < 0 || std::size_t(face) >= g.mesh.faces.size()) throw nb::index_error("face out of range");
    const Vec3 p{point.data()[0], point.data()[1], point.data()[2]};
    if (!finite(p)) throw nb::value_error("point must be finite");
    return {std::int32_t(face), p};
}

double positive(double length, const char* message) {
    if (!(length > 0.0) || !std::isfinite(length)) throw nb::value_error(message);
    return length;
}

nb::object ints(std::vector<std::int32_t>&& values) {
    const std::size_t n = values.size();
    return make_array(std::move(values), {n});
}

nb::object doubles(std::vector<double>&& values) {
    const std::size_t n = values.size();
    return make_array(std::move(values), {n});
}

nb::tuple around(Geodesic& g, std::int64_t face, Vector3 point, double limit) {
    const SurfacePoint source = surface_point(g, face, point);
    positive(limit, "limit must be a positive length in metres");
    std::vector<std::int32_t> vertices;
    std::vector<double> distances;
    {
        const nb::gil_scoped_release release;
        const std::lock_guard lock(g.busy);
        g.field.start(limit);
        g.field.seed(source.face, source.point, 0);
        g.field.run();
        std::vector<std::int32_t> touched = g.field.touched();
        std::sort(touched.begin(), touched.end());
        touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
        for (std::int32_t v : touched)
            if (g.field.distance(v) <= limit) {
                vertices.push_back(v);
                distances.push_back(g.field.distance(v));
            }
    }
    return nb::make_tuple(ints(std::move(vertices)), doubles(std::move(distances)));
}

nb::tuple spread(Geodesic& g, Ints sources, double limit) {
    positive(limit, "limit must be a positive length in metres");
    for (std::size_t i = 0; i < sources.shape(0); ++i)
        if (sources.data()[i] < 0 || std::size_t(sources.data()[i]) >= g.mesh.vertices.size())
            throw nb::index_error("vertex out of range");
    std::vector<std::int32_t> faces;
    std::vector<double> distances;
    {
        const nb::gil_scoped_release release;
        const std::lock_guard lock(g.busy);
        g.field.start(limit, true);
        for (std::size_t i = 0; i < sources.shape(0); ++i)
            g.field.seed_vertex(sources.data()[i], std::int32_t(i));
        g.field.run();
        g.field.each_touched_facet([&](std::int32_t f) {
            if (g.field.centroid_distance(f) <= limit) faces.push_back(f);
        });
        std::sort(faces.begin(), faces.end());
        for (std::int32_t f : faces) distances.push_back(g.field.centroid_distance(f));
    }
    return nb::make_tuple(ints(std::move(faces)), doubles(std::move(distances)));
}

nb::object extend(Geodesic& g, std::int64_t face, Vector3 point, bool joined) {
    const SurfacePoint to = surface_point(g, face, point);
    std::vector<std::int32_t> fresh;
    {
        const nb::gil_scoped_release release;
        const std::lock_guard lock(g.busy);
        if (!g.drawing) throw std::invalid_argument("begin a stroke first");
        fresh = g.brush.extend(to, joined);
        std::sort(fresh.begin(), fresh.end());
    }
    return ints(std::move(fresh));
}

nb::object path(Geodesic& g, std::int64_t from, Vector3 start, std::int64_t to, Vector3 end) {
    const SurfacePoint first = surface_point(g, from, start), last = surface_point(g, to, end);
    std::vector<double> rows;
    {
        const nb::gil_scoped_release release;
        const std::lock_guard lock(g.busy);
        for (const SurfacePoint& p : g.paths.find(first, last))
            rows.insert(rows.end(), {p.point.x, p.point.y, p.point.z});
    }
    const std::size_t n = rows.size() / 3;
    return make_array(std::move(rows), {n, 3});
}

nb::tuple neighbours(const Geodesic& g) {
    const std::vector<std::int32_t>& starts = g.mesh.adjacency.edge_starts();
    std::vector<std::int32_t> first(g.mesh.faces.size() + 1);
    for (std::size_t f = 0; f < first.size(); ++f) first[f] = starts[3 * f];
    std::vector<std::int32_t> copy = g.mesh.adjacency.neighbours();
    return nb::make_tuple(ints(std::move(first)), ints(std::move(copy)));
}

}  // namespace

void bind_geodesic(nb::module_& m) {
    nb::class_<Geodesic>(m, "Geodesic", "Distances along a surface, ways on it, and brush strokes over it.")
        .def("__init__", &construct, nb::arg("vertices"), nb::arg("faces").noconvert())
        .def("neighbours", &neighbours,
             "Facets across the edges: those of facet f are second[first[f]:first[f + 1]]; two int32 arrays.")
        .def("around", &around, nb::arg("face"), nb::arg("point"), nb::arg("limit"),
             "Vertices (k,) int32 within `limit` metres, along the surface, of a point of a facet; distances (k,).")
        .def("spread", &spread, nb::arg("vertices").noconvert(), nb::arg("limit"),
             "Facets (k,) int32 whose centroid lies within `limit` metres of vertices and of the lines between them; "
             "distances (k,).")
        .def("path", &path, nb::arg("from_face"), nb::arg("from_point"), nb::arg("to_face"), nb::arg("to_point"),
             "Corners (k, 3) of a way along the surface, as straight as seen from above; (0, 3) if there is none.")
        .def("begin", [](Geodesic& g, double radius, bool geodesic) {
            positive(radius, "radius must be a positive length in metres");
            const std::lock_guard lock(g.busy);
            g.brush.begin(radius, geodesic);
            g.drawing = true;
        }, nb::arg("radius"), nb::arg("geodesic"), "Begin a stroke; the one before it is forgotten.")
        .def("extend", &extend, nb::arg("face"), nb::arg("point"), nb::arg("joined"),
             "Go on to a point of a facet; the facets (k,) int32 that are covered anew, ascending.");
}

}  // namespace contactbench::bindings
