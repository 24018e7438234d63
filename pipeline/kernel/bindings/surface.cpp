// Nearest points and rays, for many queries at once.
#include <nanobind/stl/tuple.h>

#include "bindings.hpp"
#include "contactbench/crossings.hpp"
#include "contactbench/surface.hpp"
#include "parts.hpp"

namespace contactbench::bindings {

namespace {

constexpr std::size_t least = 4096;  // queries that are worth a thread

Vec3 row(const Rows3& rows, std::size_t i) { return three(rows.data() + 3 * i); }

void refuse_infinite(const Rows3& rows, const char* what) {
    for (std::size_t i = 0; i < rows.shape(0); ++i)
        if (!finite(row(rows, i)))
            throw nb::value_error((std::string(what) + ": row " + std::to_string(i) + " is not finite").c_str());
}

struct Mesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> faces;
};

Mesh to_mesh(const Rows3& vertices, const Faces& faces) {
    refuse_infinite(vertices, "vertices");
    Mesh mesh{to_points(vertices), to_triangles(faces)};
    refuse_missing(mesh.faces, mesh.vertices.size());
    return mesh;
}

Surface* make_surface(const Rows3& vertices, const Faces& faces) {
    Mesh mesh = to_mesh(vertices, faces);
    if (mesh.faces.empty()) throw nb::value_error("faces: there are none");
    nb::gil_scoped_release release;
    return new Surface(std::move(mesh.vertices), std::move(mesh.faces));
}

nb::tuple crossings(const Rows3& vertices, const Faces& faces, std::size_t limit) {
    Mesh mesh = to_mesh(vertices, faces);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z})
            if (!fit_for_exact(mesh.vertices[i].*axis))
                throw nb::value_error(("vertices: row " + std::to_string(i) + " is beyond 1e90").c_str());
    Crossings found;
    {
        nb::gil_scoped_release release;
        found = find_crossings(mesh.vertices, std::move(mesh.faces), limit);
    }
    const std::size_t k = found.kinds.size();
    return nb::make_tuple(make_array(std::move(found.pairs), {k, 2}), make_array(std::move(found.kinds), {k}),
                          make_array(std::vector<std::int64_t>(found.count.begin(), found.count.end()), {3}),
                          found.complete);
}

nb::tuple closest(const Surface& surface, const Rows3& points) {
    refuse_infinite(points, "points");
    const std::size_t n = points.shape(0);
    std::vector<double> distance(n), place(3 * n);
    std::vector<std::int32_t> face(n);
    {
        nb::gil_scoped_release release;
        in_parts(n, least, [&](std::size_t from, std::size_t to, std::size_t) {
            std::int32_t guess = -1;  // neighbours in the list are often neighbours in space
            for (std::size_t i = from; i < to; ++i) {
                const Nearest found = surface.nearest(row(points, i), guess);
                guess = face[i] = found.face;
                distance[i] = std::sqrt(found.distance2);
                place[3 * i] = found.point.x, place[3 * i + 1] = found.point.y, place[3 * i + 2] = found.point.z;
            }
        });
    }
    return nb::make_tuple(make_array(std::move(distance), {n}), make_array(std::move(face), {n}),
                          make_array(std::move(place), {n, 3}));
}

nb::tuple best_aligned(const Surface& surface, const Rows3& points, const Rows3& directions,
                       const nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>& radius,
                       const Rows3& normals, double enough) {
    refuse_infinite(points, "points");
    const std::size_t n = points.shape(0);
    if (directions.shape(0) != n || radius.shape(0) != n) throw nb::value_error("points, directions and radius differ in number");
    if (normals.shape(0) != surface.size()) throw nb::value_error("normals: not one per facet");
    std::vector<double> cosine(n);
    std::vector<std::int32_t> face(n);
    {
        nb::gil_scoped_release release;
        const auto normal = [&](std::int32_t facet) { return row(normals, std::size_t(facet)); };
        in_parts(n, least, [&](std::size_t from, std::size_t to, std::size_t) {
            for (std::size_t i = from; i < to; ++i) {
                const auto best = surface.best_aligned(row(points, i), row(directions, i), radius.data()[i], normal, enough);
                cosine[i] = best.cosine, face[i] = best.face;
            }
        });
    }
    return nb::make_tuple(make_array(std::move(cosine), {n}), make_array(std::move(face), {n}));
}

std::pair<std::vector<double>, std::vector<std::int32_t>> cast_all(const Surface& surface, const Rows3& origins,
                                                                   const Rows3& directions, bool any) {
    refuse_infinite(origins, "origins");
    refuse_infinite(directions, "directions");
    const std::size_t n = origins.shape(0);
    if (directions.shape(0) != n) throw nb::value_error("origins and directions differ in number");
    std::vector<double> t(n);
    std::vector<std::int32_t> face(n);
    nb::gil_scoped_release release;
    in_parts(n, least, [&](std::size_t from, std::size_t to, std::size_t) {
        for (std::size_t i = from; i < to; ++i) {
            const RayHit hit = surface.cast(row(origins, i), row(directions, i), any);
            t[i] = hit.t, face[i] = hit.face;
        }
    });
    return {std::move(t), std::move(face)};
}

nb::tuple first_hit(const Surface& surface, const Rows3& origins, const Rows3& directions) {
    auto [t, face] = cast_all(surface, origins, directions, false);
    return nb::make_tuple(make_array(std::move(t)), make_array(std::move(face)));
}

nb::object escapes(const Surface& surface, const Rows3& origins, const Rows3& directions) {
    auto [t, face] = cast_all(surface, origins, directions, true);
    const std::size_t n = face.size();
    auto* free = new bool[n];
    for (std::size_t i = 0; i < n; ++i) free[i] = face[i] < 0;
    nb::capsule owner(free, [](void* p) noexcept { delete[] static_cast<bool*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, bool>(free, {n}, owner));
}

}  // namespace

void bind_surface(nb::module_& m) {
    nb::class_<Surface>(m, "SurfaceIndex", "A triangle mesh, indexed for nearest points and rays. Any unit, any frame.")
        .def("__init__", [](Surface* self, const Rows3& vertices, const Faces& faces) {
            std::unique_ptr<Surface> made(make_surface(vertices, faces));
            new (self) Surface(std::move(*made));
        }, nb::arg("vertices"), nb::arg("faces"),
           "Index a copy of vertices (n, 3) float64 and faces (m, 3) int32; ValueError on a number that is not"
           " finite or an index out of range.")
        .def("__len__", &Surface::size, "Number of facets.")
        .def("closest", &closest, nb::arg("points"),
             "Nearest point of the surface to each of points (k, 3): distance (k,), facet (k,), point (k, 3).")
        .def("best_aligned", &best_aligned, nb::arg("points"), nb::arg("directions"), nb::arg("radius"),
             nb::arg("normals"), nb::arg("enough") = std::numeric_limits<double>::infinity(),
             "Of the facets within radius (k,) of each point (k, 3), the one whose normal, of normals (m, 3), has the largest"
             " dot product with the point's direction (k, 3): that product (k,), -1 for none, and facet (k,), -1. The"
             " search for a point ends at the first that is `enough`.")
        .def("first_hit", &first_hit, nb::arg("origins"), nb::arg("directions"),
             "First facet on each half-line: t (k,), in lengths of its direction, inf for none, and facet (k,), -1.")
        .def("escapes", &escapes, nb::arg("origins"), nb::arg("directions"),
             "Whether each half-line meets no facet at all: (k,) bool.");
    m.def("crossings", &crossings, nb::arg("vertices"), nb::arg("faces"), nb::arg("limit") = 100'000,
          "Facets of vertices (n, 3) float64 and faces (m, 3) int32 that share points beyond their common vertices and"
          " edges, decided exactly: pairs (k, 2) int32, ascending; their kinds (k,) uint8, 0 crossing, 1 touching only, 2"
          " sharing an area; how many there are of each kind (3,) int64; and whether every pair was looked at. At most `limit`"
          " crossings and overlaps are listed, where the search stops, and at most `limit` touching pairs. Facets without"
          " area are left out; a coordinate below 1e-75 counts as 0, ValueError beyond 1e90.");
}

}  // namespace contactbench::bindings
