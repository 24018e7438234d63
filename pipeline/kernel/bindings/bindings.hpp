// Shared by the binding files: what Python sees of an answer, and how arrays come and go.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

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
