// The runtime for Python: the same class that the C library wraps.
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <chrono>
#include <mutex>

#include "bindings.hpp"
#include "contactbench/runtime.hpp"

namespace contactbench::bindings {

namespace {

using Matrix3 = nb::ndarray<const double, nb::shape<3, 3>, nb::c_contig, nb::device::cpu>;
using Rotations = nb::ndarray<const double, nb::shape<-1, 3, 3>, nb::c_contig, nb::device::cpu>;
using Doubles = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Vector12 = nb::ndarray<const double, nb::shape<12>, nb::c_contig, nb::device::cpu>;
using Vector5 = nb::ndarray<const double, nb::shape<5>, nb::c_contig, nb::device::cpu>;

struct PyRuntime {
    Runtime runtime;
    std::mutex busy;
};

struct RuntimeBatch {
    std::shared_ptr<std::vector<RuntimeContact>> rows;
};

Vec3 three(const double* p) { return {p[0], p[1], p[2]}; }

template <class Array>
void copy_finite(const Array& from, double* to, const char* what) {
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (!std::isfinite(from.data()[i])) throw std::invalid_argument(std::string(what) + " is not finite");
        to[i] = from.data()[i];
    }
}

std::vector<Section> to_sections(const Rows6& rows) {
    std::vector<Section> sections(rows.shape(0));
    for (std::size_t i = 0; i < sections.size(); ++i) {
        double v[6];
        for (std::size_t k = 0; k < 6; ++k) v[k] = rows.data()[6 * i + k];
        for (const double x : v)
            if (!std::isfinite(x)) throw std::invalid_argument("a section of the low-pass is not finite");
        if (v[3] != 1.0) throw std::invalid_argument("a section of the low-pass has a0 other than 1");
        sections[i] = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    }
    return sections;
}

// `kalman`: rate, q, r, tuned rate, 1 for per sample.
void set_kalman(RuntimeSettings& s, nb::object kalman) {
    if (kalman.is_none()) return;
    Vector5 v;
    if (!nb::try_cast(kalman, v)) throw nb::type_error("kalman must be five float64 numbers or None");
    double k[5];
    copy_finite(v, k, "kalman");
    for (int i = 0; i < 4; ++i)
        if (!(k[i] > 0.0)) throw std::invalid_argument("kalman: rate, q, r and tuned rate must be positive");
    s.filter_wrench = true;
    s.kalman = {k[0], k[1], k[2], k[3], k[4] != 0.0};
}

struct Samples {
    Rows6 wrenches;
    Rotations rotations;
    Doubles times;

    std::size_t size() const { return times.shape(0); }
    void check() const {
        if (wrenches.shape(0) != size() || rotations.shape(0) != size())
            throw nb::value_error("wrenches, rotations and times must have one row per sample");
    }
    RuntimeContact run(Runtime& runtime, std::size_t i) const {
        return runtime.update(wrenches.data() + 6 * i, rotations.data() + 9 * i, times.data()[i]);
    }
};

RuntimeBatch update_batch(PyRuntime& self, Rows6 wrenches, Rotations rotations, Doubles times) {
    const Samples samples{wrenches, rotations, times};
    samples.check();
    auto rows = std::make_shared<std::vector<RuntimeContact>>(samples.size());
    nb::gil_scoped_release release;
    const std::lock_guard lock(self.busy);
    for (std::size_t i = 0; i < samples.size(); ++i) (*rows)[i] = samples.run(self.runtime, i);
    return {std::move(rows)};
}

nb::object time_each(PyRuntime& self, Rows6 wrenches, Rotations rotations, Doubles times) {
    const Samples samples{wrenches, rotations, times};
    samples.check();
    std::vector<double> ns(samples.size());
    std::int64_t faces = 0;
    {
        nb::gil_scoped_release release;
        const std::lock_guard lock(self.busy);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const auto start = std::chrono::steady_clock::now();
            const RuntimeContact c = samples.run(self.runtime, i);
            const auto stop = std::chrono::steady_clock::now();
            faces += c.face;  // used, so that no update can be optimised away
            ns[i] = std::chrono::duration<double, std::nano>(stop - start).count();
        }
    }
    if (faces == std::numeric_limits<std::int64_t>::min()) throw std::runtime_error("unreachable");
    return make_array(std::move(ns), {samples.size()});
}

// A strided view of one member of every row; it keeps the rows alive.
template <class T, class Member>
nb::object column(const RuntimeBatch& b, Member RuntimeContact::*member, std::initializer_list<std::size_t> inner) {
    nb::capsule owner(new std::shared_ptr<std::vector<RuntimeContact>>(b.rows), [](void* p) noexcept {
        delete static_cast<std::shared_ptr<std::vector<RuntimeContact>>*>(p);
    });
    std::vector<std::size_t> shape{b.rows->size()};
    std::vector<std::int64_t> strides{std::int64_t(sizeof(RuntimeContact) / sizeof(T))};
    shape.insert(shape.end(), inner);
    for (std::size_t i = 1; i < shape.size(); ++i) {
        std::int64_t step = 1;
        for (std::size_t k = i + 1; k < shape.size(); ++k) step *= std::int64_t(shape[k]);
        strides.push_back(step);
    }
    static RuntimeContact none;  // an address for an empty batch
    RuntimeContact& first = b.rows->empty() ? none : b.rows->front();
    const T* data = reinterpret_cast<const T*>(&(first.*member));
    return nb::cast(nb::ndarray<nb::numpy, const T>(data, shape.size(), shape.data(), owner, strides.data()));
}

nb::object index_or_none(std::int32_t i) { return i < 0 ? nb::none() : nb::cast(i); }

nb::object point_or_none(const double* p) {
    return std::isnan(p[0]) ? nb::none() : to_array(three(p));
}

nb::object covariance_or_none(const RuntimeContact& c) {
    if (std::isnan(c.point[0])) return nb::none();
    return make_array(std::vector<double>(c.covariance, c.covariance + 9), {3, 3});
}

void bind_contact_class(nb::module_& m) {
    using C = RuntimeContact;
    nb::class_<C>(m, "RuntimeContact", "What the runtime says of one sample.")
        .def_prop_ro("reason", [](const C& c) { return c.reason; }, "Reason.")
        .def_prop_ro("reason_name", [](const C& c) { return std::string(reason_name(c.reason)); }, "The same in words.")
        .def_prop_ro("accepted", [](const C& c) { return c.accepted != 0; }, "Safe to act on.")
        .def_prop_ro("time", [](const C& c) { return c.time; }, "s, as given.")
        .def_prop_ro("point", [](const C& c) { return point_or_none(c.point); }, "(3,) S, m, or None.")
        .def_prop_ro("normal", [](const C& c) { return point_or_none(c.normal); }, "(3,) S, outward, or None.")
        .def_prop_ro("torque", [](const C& c) { return c.torque_about_normal; }, "Local torque k, N·m; NaN without a point.")
        .def_prop_ro("wrench", [](const C& c) { return point_or_none(c.wrench).is_none() ? nb::none()
            : make_array(std::vector<double>(c.wrench, c.wrench + 6), {6}); },
            "(6,) S, N and N·m: compensated and filtered; None before the first sample that counts.")
        .def_prop_ro("covariance", &covariance_or_none, "(3, 3) S, m², or None.")
        .def_prop_ro("face", [](const C& c) { return index_or_none(c.face); }, "Face number, or None.")
        .def_prop_ro("vertex", [](const C& c) { return index_or_none(c.vertex); }, "Vertex number, or None.")
        .def_prop_ro("region", [](const C& c) { return c.region; }, "Region rank, 0 for none.")
        .def_prop_ro("candidates", [](const C& c) { return c.candidates; }, "How many, the chosen one included.")
        .def_prop_ro("filtered_point", [](const C& c) { return point_or_none(c.filtered_point); },
                     "(3,) S, m: low-passed, held while contact is lost for a moment; None after that.")
        .def_prop_ro("misfit", [](const C& c) { return c.misfit; }, "d2 of the best touch, standard deviations squared.")
        .def_prop_ro("left_over", [](const C& c) { return c.left_over; }, "Torque that it does not explain, N·m.")
        .def_prop_ro("arm", [](const C& c) { return c.arm; }, "Torque along the force over the force, m.")
        .def_prop_ro("confidence", [](const C& c) { return c.confidence; }, "0 to 1.")
        .def_prop_ro("runner_up", [](const C& c) { return point_or_none(c.runner_up); },
                     "(3,) S, m: the likeliest other place, or None.")
        .def_prop_ro("second", [](const C& c) { return point_or_none(c.second); },
                     "(3,) S, m: a touch that joined this one, or None.");
}

void bind_batch_class(nb::module_& m) {
    using B = RuntimeBatch;
    using C = RuntimeContact;
    nb::class_<B>(m, "RuntimeBatch", "What the runtime says of many samples, a row each; NaN and -1 for none.")
        .def("__len__", [](const B& b) { return b.rows->size(); })
        .def("__getitem__", [](const B& b, std::int64_t i) {
            const std::int64_t n = std::int64_t(b.rows->size());
            if (i < -n || i >= n) throw nb::index_error("row out of range");
            return (*b.rows)[std::size_t(i < 0 ? i + n : i)];
        }, nb::arg("row"), "One row.")
        .def_prop_ro("reasons", [](const B& b) { return column<std::int32_t>(b, &C::reason, {}); }, "(n,) int32.")
        .def_prop_ro("faces", [](const B& b) { return column<std::int32_t>(b, &C::face, {}); }, "(n,) int32.")
        .def_prop_ro("vertices", [](const B& b) { return column<std::int32_t>(b, &C::vertex, {}); }, "(n,) int32.")
        .def_prop_ro("regions", [](const B& b) { return column<std::int32_t>(b, &C::region, {}); }, "(n,) int32.")
        .def_prop_ro("candidates", [](const B& b) { return column<std::int32_t>(b, &C::candidates, {}); }, "(n,) int32.")
        .def_prop_ro("times", [](const B& b) { return column<double>(b, &C::time, {}); }, "(n,) s.")
        .def_prop_ro("points", [](const B& b) { return column<double>(b, &C::point, {3}); }, "(n, 3) S, m.")
        .def_prop_ro("normals", [](const B& b) { return column<double>(b, &C::normal, {3}); }, "(n, 3) S.")
        .def_prop_ro("torques", [](const B& b) { return column<double>(b, &C::torque_about_normal, {}); }, "(n,) k, N·m.")
        .def_prop_ro("wrenches", [](const B& b) { return column<double>(b, &C::wrench, {6}); }, "(n, 6) S, N and N·m.")
        .def_prop_ro("covariances", [](const B& b) { return column<double>(b, &C::covariance, {3, 3}); }, "(n, 3, 3) S, m².")
        .def_prop_ro("filtered_points", [](const B& b) { return column<double>(b, &C::filtered_point, {3}); }, "(n, 3) S, m.")
        .def_prop_ro("accepted", [](const B& b) { return column<std::int32_t>(b, &C::accepted, {}); }, "(n,) int32: 1 where safe to act on.")
        .def_prop_ro("misfits", [](const B& b) { return column<double>(b, &C::misfit, {}); }, "(n,) standard deviations squared.")
        .def_prop_ro("left_overs", [](const B& b) { return column<double>(b, &C::left_over, {}); }, "(n,) N·m.")
        .def_prop_ro("arms", [](const B& b) { return column<double>(b, &C::arm, {}); }, "(n,) m.")
        .def_prop_ro("confidences", [](const B& b) { return column<double>(b, &C::confidence, {}); }, "(n,) 0 to 1.")
        .def_prop_ro("runners_up", [](const B& b) { return column<double>(b, &C::runner_up, {3}); }, "(n, 3) S, m.")
        .def_prop_ro("seconds", [](const B& b) { return column<double>(b, &C::second, {3}); }, "(n, 3) S, m.");
}

}  // namespace

void bind_runtime(nb::module_& m) {
    bind_contact_class(m);
    bind_batch_class(m);
    auto runtime = nb::class_<PyRuntime>(m, "Runtime", "What a controller runs at every sample; one stream.");
    runtime.def("__init__", [](PyRuntime* self, Rows3 vertices, Faces faces, Ints region, Matrix6 noise, Vector12 gravity,
                               nb::object kalman, Rows6 sections, Bonus bonus, double torsion_arm,
                               double mesh_deviation, bool mesh_curved, CONTACTBENCH_GATES) {
        RuntimeSettings s;
        s.gates = CONTACTBENCH_GIVEN_GATES;
        s.torsion_arm = torsion_arm;
        copy_finite(noise, &s.noise.s[0][0], "the wrench covariance");
        double g[12];
        copy_finite(gravity, g, "the gravity model");
        s.gravity = {three(g), three(g + 3), three(g + 6), three(g + 9)};
        set_kalman(s, std::move(kalman));
        s.sections = to_sections(sections);
        new (self) PyRuntime{Runtime(to_model(vertices, faces, region, bonus, mesh_deviation, mesh_curved), s), {}};
    }, nb::arg("vertices"), nb::arg("faces").noconvert(), nb::arg("region").noconvert(), nb::arg("noise"),
       nb::arg("gravity"), nb::kw_only(), nb::arg("kalman").none(), nb::arg("sections"), nb::arg("bonus"),
       nb::arg("torsion_arm"), nb::arg("mesh_deviation"), nb::arg("mesh_curved"), CONTACTBENCH_GATE_NAMES);
    runtime.def("update", [](PyRuntime& s, Vector6 wrench, Matrix3 R_WS, double time) {
        const std::lock_guard lock(s.busy);
        return s.runtime.update(wrench.data(), R_WS.data(), time);
    }, nb::arg("wrench"), nb::arg("R_WS"), nb::arg("time"),
       "The next sample: a raw reading (6,) in S, N and N·m, the sensor's orientation (3, 3), and its time, s.");
    runtime.def("update_batch", &update_batch, nb::arg("wrenches"), nb::arg("rotations"), nb::arg("times"),
                "The next samples (n, 6), (n, 3, 3), (n,), in order, without the interpreter's lock.");
    runtime.def("time_each", &time_each, nb::arg("wrenches"), nb::arg("rotations"), nb::arg("times"),
                "Nanoseconds of each update (n,).");
    runtime.def("reset", [](PyRuntime& s) {
        const std::lock_guard lock(s.busy);
        s.runtime.reset();
    }, "Forget the stream: the next sample is a first one.");
}

}  // namespace contactbench::bindings
