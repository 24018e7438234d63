// Shared by the binding files: what Python sees of an answer, and how arrays come and go.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <chrono>

#include "contactbench/algorithm1.hpp"
#include "contactbench/paraboloid.hpp"
#include "contactbench/scan.hpp"
#include "contactbench/solver.hpp"

namespace nb = nanobind;

namespace contactbench::bindings {

using Vector6 = nb::ndarray<const double, nb::shape<6>, nb::c_contig, nb::device::cpu>;
using Rows6 = nb::ndarray<const double, nb::shape<-1, 6>, nb::c_contig, nb::device::cpu>;
using Rows3 = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Vector3 = nb::ndarray<const double, nb::shape<3>, nb::c_contig, nb::device::cpu>;
using Faces = nb::ndarray<const std::int32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Ints = nb::ndarray<const std::int32_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Matrix6 = nb::ndarray<const double, nb::shape<6, 6>, nb::c_contig, nb::device::cpu>;

inline Wrench to_wrench(const double* p) { return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}}; }

// Anything that NumPy can turn into rows of six numbers; the fast path takes float64 arrays as they are.
Rows6 to_rows(nb::handle wrenches);
// Six numbers from any sequence.
Wrench to_wrench(nb::handle wrench);

// A fresh NumPy array that owns its memory.
template <class T>
nb::object make_array(std::vector<T>&& values, std::initializer_list<std::size_t> shape) {
    auto* owned = new std::vector<T>(std::move(values));
    nb::capsule owner(owned, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, T>(owned->data(), shape.size(), shape.begin(), owner));
}

// The same with one dimension.
template <class T>
nb::object make_array(std::vector<T>&& values) {
    const std::size_t n = values.size();
    return make_array(std::move(values), {n});
}

inline Vec3 three(const double* p) { return {p[0], p[1], p[2]}; }

inline std::vector<Vec3> to_points(const Rows3& rows) {
    std::vector<Vec3> points(rows.shape(0));
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = three(rows.data() + 3 * i);
    return points;
}

inline std::vector<Triangle> to_triangles(const Faces& faces) {
    std::vector<Triangle> triangles(faces.shape(0));
    for (std::size_t f = 0; f < triangles.size(); ++f) std::copy_n(faces.data() + 3 * f, 3, triangles[f].begin());
    return triangles;
}

// Throws where a facet of a mesh of so many vertices has another one.
inline void refuse_missing(const std::vector<Triangle>& triangles, std::size_t vertices) {
    for (std::size_t f = 0; f < triangles.size(); ++f)
        for (const std::int32_t v : triangles[f])
            if (v < 0 || std::size_t(v) >= vertices)
                throw nb::value_error(("faces: row " + std::to_string(f) + " refers to a vertex that is not there").c_str());
}

// Nanoseconds of each `call(i)`, clock included (about 20 ns), without the interpreter's lock. It returns a number, which is
// used, so that no call can be optimised away.
template <class Call>
nb::object time_calls(std::size_t n, const Call& call) {
    std::vector<double> ns(n);
    std::int64_t used = 0;
    {
        nb::gil_scoped_release release;
        for (std::size_t i = 0; i < n; ++i) {
            const auto start = std::chrono::steady_clock::now();
            used += call(i);
            const auto stop = std::chrono::steady_clock::now();
            ns[i] = std::chrono::duration<double, std::nano>(stop - start).count();
        }
    }
    if (used == std::numeric_limits<std::int64_t>::min()) throw std::runtime_error("unreachable");
    return make_array(std::move(ns));
}

inline nb::object to_array(Vec3 v) { return make_array<double>({v.x, v.y, v.z}, {3}); }

inline nb::object to_array(const Mat3& s) {
    return make_array<double>(std::vector<double>(&s.m[0][0], &s.m[0][0] + 9), {3, 3});
}

// One answer, with what is needed to work out the dearer parts when they are asked for.
struct Contact {
    std::shared_ptr<const Solver> context;  // geometry, noise and gates; its tracker is never used
    Wrench wrench;
    Answer answer;

    const Candidate* chosen() const { return answer.contact(); }
};

struct ContactCandidate {
    Candidate candidate;
    double distance;  // m, from the chosen point, NaN when there is none
    double delta;     // by what it costs more than the chosen one, NaN when there is none
};

// What a solver is made with beside the mesh and the noise, as keyword arguments.
using Bonus = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

// Of a dict: each gate by its name, and no other.
Gates to_gates(const nb::dict& given);

std::shared_ptr<const Model> to_model(const Rows3& vertices, const Faces& faces, const Ints& region, const Bonus& bonus,
                                      double mesh_deviation, bool mesh_curved);

void bind_contact(nb::module_& m);
void bind_solvers(nb::module_& m);
void bind_surface(nb::module_& m);
void bind_geodesic(nb::module_& m);
void bind_collapse(nb::module_& m);
void bind_runtime(nb::module_& m);
void bind_table(nb::module_& m);

}  // namespace contactbench::bindings
