// Distances along the surface, ways on it, and brush strokes.
#include <bit>
#include <mutex>

#include "bindings.hpp"
#include "contactbench/brush.hpp"
#include "parts.hpp"

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
    std::vector<Vec3> points = to_points(vertices);
    if (!std::all_of(points.begin(), points.end(), [](Vec3 p) { return finite(p); }))
        throw nb::value_error("vertices must be finite");
    std::vector<Triangle> triangles = to_triangles(faces);
    const nb::gil_scoped_release release;
    new (self) Geodesic(std::move(points), std::move(triangles));
}

SurfacePoint surface_point(const Geodesic& g, std::int64_t face, const double* point) {
    if (face < 0 || std::size_t(face) >= g.mesh.faces.size()) throw nb::index_error("face out of range");
    const Vec3 p = three(point);
    if (!finite(p)) throw nb::value_error("point must be finite");
    return {std::int32_t(face), p};
}

double positive(double length, const char* message) {
    if (!(length > 0.0) || !std::isfinite(length)) throw nb::value_error(message);
    return length;
}

// What one thread finds: of each source how many vertices, and all of them one after the other.
struct Surroundings {
    std::vector<std::int64_t> counts;
    std::vector<std::int32_t> vertices;
    std::vector<double> distances;

    void find(DistanceField& field, const SurfacePoint& source, double limit) {
        field.start(limit);
        field.seed(source.face, source.point, 0);
        field.run();
        near_.clear();
        for (std::int32_t v : field.touched())
            if (field.distance(v) <= limit) near_.push_back(v);
        std::sort(near_.begin(), near_.end());
        near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
        counts.push_back(std::int64_t(near_.size()));
        for (std::int32_t v : near_) {
            vertices.push_back(v);
            distances.push_back(field.distance(v));
        }
    }

private:
    std::vector<std::int32_t> near_;
};

// A field takes about as long to make as a hundred sources to spread.
constexpr std::size_t least_sources = 512;
constexpr double resolved = 1e-4;  // of a distance, for `spread`

std::vector<SurfacePoint> surface_points(const Geodesic& g, const Ints& faces, const Rows3& points) {
    if (points.shape(0) != faces.shape(0)) throw nb::value_error("faces and points differ in number");
    std::vector<SurfacePoint> found(faces.shape(0));
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = surface_point(g, faces.data()[i], points.data() + 3 * i);
    return found;
}

nb::tuple around(const Geodesic& g, Ints faces, Rows3 points, double limit) {
    positive(limit, "limit must be a positive length in metres");
    const std::vector<SurfacePoint> sources = surface_points(g, faces, points);
    const std::size_t n = sources.size();
    std::vector<std::int64_t> first{0};
    Surroundings whole;
    {
        const nb::gil_scoped_release release;
        std::vector<Surroundings> parts(parts_of(n, least_sources));
        in_parts(n, least_sources, [&](std::size_t from, std::size_t to, std::size_t part) {
            DistanceField field(g.mesh);
            for (std::size_t i = from; i < to; ++i) parts[part].find(field, sources[i], limit);
        });
        first.reserve(n + 1);
        for (Surroundings& part : parts) {
            for (std::int64_t count : part.counts) first.push_back(first.back() + count);
            whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
            whole.distances.insert(whole.distances.end(), part.distances.begin(), part.distances.end());
            part = {};
        }
    }
    return nb::make_tuple(make_array(std::move(first)), make_array(std::move(whole.vertices)),
                          make_array(std::move(whole.distances)));
}

// Where the nearest source's way leads over an edge, hardly an end of it is nearer to another source by more than the edge is
// long: a wave that comes later ends there. Sources that lie apart come first, so most waves end early.
nb::tuple spread(Geodesic& g, Ints faces, Rows3 points, double limit) {
    positive(limit, "limit must be a positive length in metres");
    const std::vector<SurfacePoint> sources = surface_points(g, faces, points);
    std::vector<std::int32_t> vertices;
    std::vector<double> distances;
    {
        const nb::gil_scoped_release release;
        const std::lock_guard lock(g.busy);
        std::vector<double> longest(g.mesh.vertices.size(), 0.0), most(longest.size(), DistanceField::unreached), nearest = most;
        for (std::size_t f = 0; f < g.mesh.faces.size(); ++f)
            for (std::size_t c = 0; c < 3; ++c) {
                const auto a = std::size_t(g.mesh.faces[f][c]), b = std::size_t(g.mesh.faces[f][(c + 1) % 3]);
                const double edge = norm(g.mesh.vertices[a] - g.mesh.vertices[b]);
                longest[a] = std::max(longest[a], edge), longest[b] = std::max(longest[b], edge);
            }
        for (std::size_t step = std::bit_ceil(sources.size()), i = 0; step; step /= 2)
            for (i = step; i <= sources.size(); i += 2 * step) {
                g.field.start(limit, resolved);
                g.field.seed(sources[i - 1].face, sources[i - 1].point, 0);
                g.field.run(&most);
                for (std::int32_t touched : g.field.touched()) {
                    const auto v = std::size_t(touched);
                    nearest[v] = std::min(nearest[v], g.field.distance(touched));
                    most[v] = nearest[v] + longest[v];
                }
            }
        for (std::size_t v = 0; v < nearest.size(); ++v)
            if (nearest[v] <= limit) vertices.push_back(std::int32_t(v)), distances.push_back(nearest[v]);
    }
    return nb::make_tuple(make_array(std::move(vertices)), make_array(std::move(distances)));
}

nb::object extend(Geodesic& g, std::int64_t face, Vector3 point, bool joined) {
    const SurfacePoint to = surface_point(g, face, point.data());
    std::vector<std::int32_t> fresh;
    {
        const nb::gil_scoped_release release;
        const std::lock_guard lock(g.busy);
        if (!g.drawing) throw std::invalid_argument("begin a stroke first");
        fresh = g.brush.extend(to, joined);
        std::sort(fresh.begin(), fresh.end());
    }
    return make_array(std::move(fresh));
}

nb::object path(Geodesic& g, std::int64_t from, Vector3 start, std::int64_t to, Vector3 end) {
    const SurfacePoint first = surface_point(g, from, start.data()), last = surface_point(g, to, end.data());
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
    return nb::make_tuple(make_array(std::move(first)), make_array(std::move(copy)));
}

}  // namespace

void bind_geodesic(nb::module_& m) {
    nb::class_<Geodesic>(m, "Geodesic", "Distances along a surface, ways on it, and brush strokes over it.")
        .def("__init__", &construct, nb::arg("vertices"), nb::arg("faces").noconvert())
        .def("neighbours", &neighbours,
             "Facets across the edges: those of facet f are second[first[f]:first[f + 1]]; two int32 arrays.")
        .def("around", &around, nb::arg("faces").noconvert(), nb::arg("points"), nb::arg("limit"),
             "Vertices (k,) int32 within `limit` metres, along the surface, of each of points (n, 3) of facets (n,): those of"
             " point i number first[i] to first[i + 1], ascending. first (n + 1,) int64, vertices, and distances (k,).")
        .def("spread", &spread, nb::arg("faces").noconvert(), nb::arg("points"), nb::arg("limit"),
             "Vertices (k,) int32 within `limit` metres, along the surface, of any of points (n, 3) of facets (n,), ascending; "
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
