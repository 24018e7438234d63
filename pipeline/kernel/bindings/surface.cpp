// Nearest points and rays, for many queries at once.
#include <nanobind/stl/tuple.h>

#include <thread>

#include "bindings.hpp"
#include "contactbench/surface.hpp"

namespace contactbench::bindings {

namespace {

Vec3 row(const Rows3& rows, std::size_t i) {
    const double* p = rows.data() + 3 * i;
    return {p[0], p[1], p[2]};
}

void refuse_infinite(const Rows3& rows, const char* what) {
    for (std::size_t i = 0; i < rows.shape(0); ++i)
        if (!finite(row(rows, i)))
            throw nb::value_error((std::string(what) + ": row " + std::to_string(i) + " is not finite").c_str());
}

Surface* make_surface(const Rows3& vertices, const Faces& faces) {
    refuse_infinite(vertices, "vertices");
    if (faces.shape(0) == 0) throw nb::value_error("faces: there are none");
    std::vector<Vec3> points(vertices.shape(0));
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = row(vertices, i);
    std::vector<std::array<std::int32_t, 3>> triangles(faces.shape(0));
    for (std::size_t f = 0; f < triangles.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t v = faces.data()[3 * f + k];
            if (v < 0 || std::size_t(v) >= points.size())
                throw nb::value_error(("faces: row " + std::to_string(f) + " refers to a vertex that is not there").c_str());
            triangles[f][k] = v;
        }
    nb::gil_scoped_release release;
    return new Surface(std::move(points), std::move(triangles));
}

// Splits many queries over the processor's cores: each is on its own, so the answer is the same.
template <class Work>
void in_parts(std::size_t count, const Work& work) {
    const std::size_t parts = std::min<std::size_t>({std::max(1u, std::thread::hardware_concurrency()), 8, 1 + count / 4096});
    std::vector<std::thread> threads;
    for (std::size_t p = 1; p < parts; ++p)
        threads.emplace_back([&work, p, parts, count] { work(count * p / parts, count * (p + 1) / parts); });
    work(0, count / parts);
    for (std::thread& t : threads) t.join();
}

nb::tuple closest(const Surface& surface, const Rows3& points) {
    refuse_infinite(points, "points");
    const std::size_t n = points.shape(0);
    std::vector<double> distance(n), place(3 * n);
    std::vector<std::int32_t> face(n);
    {
        nb::gil_scoped_release release;
        in_parts(n, [&](std::size_t from, std::size_t to) {
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

std::pair<std::vector<double>, std::vector<std::int32_t>> cast_all(const Surface& surface, const Rows3& origins,
                                                                   const Rows3& directions, bool any) {
    refuse_infinite(origins, "origins");
    refuse_infinite(directions, "directions");
    const std::size_t n = origins.shape(0);
    if (directions.shape(0) != n) throw nb::value_error("origins and directions differ in number");
    std::vector<double> t(n);
    std::vector<std::int32_t> face(n);
    nb::gil_scoped_release release;
    in_parts(n, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) {
            const RayHit hit = surface.cast(row(origins, i), row(directions, i), any);
            t[i] = hit.t, face[i] = hit.face;
        }
    });
    return {std::move(t), std::move(face)};
}

nb::tuple first_hit(const Surface& surface, const Rows3& origins, const Rows3& directions) {
    auto [t, face] = cast_all(surface, origins, directions, false);
    const std::size_t n = t.size();
    return nb::make_tuple(make_array(std::move(t), {n}), make_array(std::move(face), {n}));
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
        .def("first_hit", &first_hit, nb::arg("origins"), nb::arg("directions"),
             "First facet on each half-line: t (k,), in lengths of its direction, inf for none, and facet (k,), -1.")
        .def("escapes", &escapes, nb::arg("origins"), nb::arg("directions"),
             "Whether each half-line meets no facet at all: (k,) bool.");
}

}  // namespace contactbench::bindings
