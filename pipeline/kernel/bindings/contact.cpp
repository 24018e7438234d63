// Contact, its candidates and the reason codes.
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include "bindings.hpp"

namespace contactbench::bindings {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const char* why_text(Why why) {
    switch (why) {
        case Why::chosen: return "chosen";
        case Why::misfit: return "explains the wrench less well";
        case Why::region: return "less likely to be touched, as declared";
        case Why::previous: return "far from the previous contact";
        case Why::downstream: return "met later along the force";
    }
    return "unknown";
}

nb::object index_or_none(std::int32_t i) { return i < 0 ? nb::none() : nb::cast(i); }

double degrees_of(double cosine) { return std::acos(std::min(1.0, cosine)) * 180.0 / M_PI; }

// Every candidate but the chosen one, likeliest first.
nb::list candidates_of(const Contact& c) {
    std::vector<const Candidate*> others;
    for (std::int32_t i = 0; i < c.answer.count; ++i)
        if (i != c.answer.chosen) others.push_back(&c.answer.candidates[i]);
    std::stable_sort(others.begin(), others.end(),
                     [](const Candidate* a, const Candidate* b) { return a->cost() < b->cost(); });
    nb::list out;
    const Candidate* chosen = c.chosen();
    for (const Candidate* o : others)
        out.append(nb::cast(ContactCandidate{*o, chosen ? norm(o->point - chosen->point) : nan,
                                             chosen ? o->cost() - chosen->cost() : nan}));
    return out;
}

Mat3 covariance_of(const Contact& c) {
    const Candidate& p = *c.chosen();
    return c.context->covariance(c.wrench, p.point, p.normal, p.face, p.depth, c.answer.torsion_arm);
}

nb::object repr(const Contact& c) {
    nb::object reason = nb::cast(c.answer.reason).attr("name");
    const Candidate* p = c.chosen();
    if (!p) return nb::str("Contact({}, no point, misfit={:.3g})").format(reason, c.answer.misfit);
    return nb::str("Contact({}, point=({:.2f}, {:.2f}, {:.2f}) mm, confidence={:.3f}, misfit={:.2f}, face={}, {} other candidates)")
        .format(reason, 1e3 * p->point.x, 1e3 * p->point.y, 1e3 * p->point.z, c.answer.confidence, c.answer.misfit,
                p->face, c.answer.count - 1);
}

[[noreturn]] void wrong_input(const char* what) {
    PyErr_Clear();
    throw nb::type_error(what);
}

}  // namespace

template <class T>
void take(nb::handle value, T& to) { to = nb::cast<T>(value); }

template <std::size_t N>
void take(nb::handle value, double (&to)[N]) {
    const auto values = nb::cast<std::array<double, N>>(value);
    std::copy(values.begin(), values.end(), to);
}

Gates to_gates(const nb::dict& given) {
    Gates gates;
    std::size_t count = 0;
    each_gate(gates, [&](const char*, const char* name, auto& to, From) { take(given[name], to), ++count; });
    if (given.size() != count) throw std::invalid_argument("gates has a name that is no gate");
    return gates;
}

Rows6 to_rows(nb::handle wrenches) {
    try {
        nb::object array = nb::module_::import_("numpy").attr("ascontiguousarray")(wrenches, "float64");
        Rows6 rows;
        if (nb::try_cast(array, rows)) return rows;
    } catch (nb::python_error&) {  // the message below says more than the conversion's own
    }
    wrong_input("wrenches must have shape (n, 6): Fx Fy Fz Mx My Mz in S, N and N*m, as numbers");
}

Wrench to_wrench(nb::handle wrench) {
    if (PyBytes_Check(wrench.ptr()) || PyByteArray_Check(wrench.ptr()))
        wrong_input("a wrench is six numbers, not bytes: Fx Fy Fz Mx My Mz in S, N and N*m");
    double v[6];
    std::size_t n = 0;
    try {
        for (nb::handle item : wrench) {
            if (n == 6) wrong_input("a wrench has six numbers, this one has more: Fx Fy Fz Mx My Mz in S, N and N*m");
            v[n++] = nb::cast<double>(item);
        }
    } catch (nb::python_error&) {
        wrong_input("a wrench is six numbers: Fx Fy Fz Mx My Mz in S, N and N*m");
    } catch (nb::cast_error&) {
        wrong_input("a wrench is six numbers, and one of these is none: Fx Fy Fz Mx My Mz in S, N and N*m");
    }
    if (n != 6) wrong_input("a wrench has six numbers, this one has fewer: Fx Fy Fz Mx My Mz in S, N and N*m");
    return to_wrench(v);
}

void bind_contact(nb::module_& m) {
    nb::enum_<Reason>(m, "Reason", nb::is_arithmetic(), "Why a contact was, or was not, given.")
        .value("OK", Reason::ok, "One touch explains the wrench, and no other place does about as well.")
        .value("VERTEX", Reason::vertex, "The same, on a corner of the mesh.")
        .value("AMBIGUOUS", Reason::ambiguous, "Another place explains the wrench about as well; the likeliest is given.")
        .value("LOW_FORCE", Reason::low_force, "Force under its gate.")
        .value("TANGENTIAL", Reason::tangential, "Only a touch outside the friction cone would explain the wrench.")
        .value("OFF_SURFACE", Reason::off_surface, "No facet faces the force.")
        .value("OUTSIDE_REGION", Reason::outside_region, "On the probe, but outside every declared region.")
        .value("SATURATED", Reason::saturated, "A channel is at its limit.")
        .value("STALE", Reason::stale, "The sample is too old.")
        .value("NOT_FINITE", Reason::not_finite, "NaN or infinity in the wrench.")
        .value("NOT_A_ROTATION", Reason::not_a_rotation, "The orientation is no rotation.")
        .value("BY_REGION", Reason::by_region,
               "Sure only because of the declared regions: without them another place would do as well.")
        .value("IMPLAUSIBLE", Reason::implausible,
               "No single touch explains the wrench: two touches, a wrong model, or wrong units.")
        .value("TWO_TOUCHES", Reason::two_touches, "A second touch joined the one that is followed; both are given.")
        .value("UNHEALTHY", Reason::unhealthy, "The sensor hangs, or its clock has just leapt.")
        .value("UNCERTAIN", Reason::uncertain,
               "One place, but its standard deviation is over the gate sigma_max; tracking follows it.");

    nb::class_<ContactCandidate>(m, "Candidate", "Another place that explains the wrench, and why it lost.")
        .def_prop_ro("point", [](const ContactCandidate& c) { return to_array(c.candidate.point); }, "(3,) S, m.")
        .def_prop_ro("normal", [](const ContactCandidate& c) { return to_array(c.candidate.normal); }, "(3,) S, outward.")
        .def_prop_ro("torque", [](const ContactCandidate& c) { return c.candidate.torque; }, "Local torque k, N·m.")
        .def_prop_ro("face", [](const ContactCandidate& c) { return c.candidate.face; }, "Face number.")
        .def_prop_ro("vertex", [](const ContactCandidate& c) { return index_or_none(c.candidate.vertex); },
                     "Vertex number, None on a facet.")
        .def_prop_ro("region", [](const ContactCandidate& c) { return c.candidate.region; }, "Region rank, 0 for none.")
        .def_prop_ro("friction_angle", [](const ContactCandidate& c) { return degrees_of(c.candidate.cosine); },
                     "Between -F and the normal, degrees.")
        .def_ro("distance", &ContactCandidate::distance, "From the chosen point, m; NaN when none was chosen.")
        .def_prop_ro("misfit", [](const ContactCandidate& c) { return c.candidate.misfit; },
                     "d2: how badly it explains the wrench, standard deviations squared.")
        .def_ro("delta", &ContactCandidate::delta, "By how much less likely than the chosen one: 2 ln(odds); NaN when none was chosen.")
        .def_prop_ro("why", [](const ContactCandidate& c) { return why_text(c.candidate.why); }, "Why it lost.");

    nb::class_<Contact>(m, "Contact", "Where the probe is touched, why that is believed, and how sure it is.")
        .def_prop_ro("reason", [](const Contact& c) { return c.answer.reason; }, "Reason code.")
        .def_prop_ro("accepted", [](const Contact& c) { return accepted(c.answer.reason, c.context->gates()); },
                     "True for OK and VERTEX, and for BY_REGION where the gates say so: safe to act on.")
        .def_prop_ro("point", [](const Contact& c) -> nb::object {
            return c.chosen() ? to_array(c.chosen()->point) : nb::none(); }, "(3,) S, m, or None.")
        .def_prop_ro("normal", [](const Contact& c) -> nb::object {
            return c.chosen() ? to_array(c.chosen()->normal) : nb::none(); }, "(3,) S, outward unit normal, or None.")
        .def_prop_ro("torque", [](const Contact& c) { return c.chosen() ? c.chosen()->torque : nan; },
                     "Local torque k about the normal, N·m, by its likelihood: shrunk towards 0 as noise allows; NaN without a point.")
        .def_prop_ro("face", [](const Contact& c) { return index_or_none(c.chosen() ? c.chosen()->face : -1); },
                     "Face number; on a vertex the lowest one around it; None without a point, or where the method knows none.")
        .def_prop_ro("vertex", [](const Contact& c) { return index_or_none(c.chosen() ? c.chosen()->vertex : -1); },
                     "Vertex number when the contact is on one, else None.")
        .def_prop_ro("region", [](const Contact& c) { return c.chosen() ? c.chosen()->region : 0; },
                     "Rank of the region touched, 0 for none.")
        .def_prop_ro("friction_angle", [](const Contact& c) {
            return c.chosen() ? degrees_of(c.chosen()->cosine) : nan; }, "Between -F and the normal, degrees.")
        .def_prop_ro("misfit", [](const Contact& c) { return c.answer.misfit; },
                     "d2 of the best touch, standard deviations squared; also where no point is given.")
        .def_prop_ro("left_over", [](const Contact& c) { return c.answer.left_over; },
                     "Torque that the best touch does not explain, N·m; also where no point is given.")
        .def_prop_ro("arm", [](const Contact& c) { return c.answer.arm; },
                     "Torque along the force over the force, m: what torsion of the skin would have to reach.")
        .def_prop_ro("torsion_arm", [](const Contact& c) { return c.answer.torsion_arm; },
                     "m: torsion over force, 1 sigma, that it was judged by; declared, or learned in the run.")
        .def_prop_ro("torsion_since", [](const Contact& c) { return c.answer.torsion_since; },
                     "s: for how long that was learned; NaN: it is declared.")
        .def_prop_ro("confidence", [](const Contact& c) { return c.answer.confidence; },
                     "1 / (1 + the odds of every other place): 0 to 1, no probability.")
        .def_prop_ro("second", [](const Contact& c) -> nb::object {
            return c.answer.has_second ? to_array(c.answer.second.point) : nb::none(); },
            "(3,) S, m: a touch that joined this one while it was followed, or None.")
        .def_prop_ro("candidates", &candidates_of, "Every other candidate, likeliest first.")
        .def_prop_ro("covariance", [](const Contact& c) -> nb::object {
            return c.chosen() ? to_array(covariance_of(c)) : nb::none(); },
            "(3, 3) S, m², along the facet's plane: noise, calibration, model error, mesh; None without a point.")
        .def_prop_ro("sigma_max", [](const Contact& c) {
            if (!c.chosen()) return nan;
            return largest_sigma(covariance_of(c)); },
            "Largest standard deviation of the point, m; NaN without a point.")
        .def_prop_ro("within", [](const Contact& c) {
            const bool one = c.chosen() && !c.answer.has_second;
            return one ? sigmas_of_95 * largest_sigma(covariance_of(c)) : nan; },
            "m: how far the 95 % ellipse of the point reaches; NaN without a point, and for TWO_TOUCHES.")
        .def_prop_ro("ellipse", [](const Contact& c) -> nb::object {
            if (!c.chosen()) return nb::none();
            const auto axes = ellipse_axes(covariance_of(c), c.chosen()->normal);
            return make_array<double>({axes[0].x, axes[0].y, axes[0].z, axes[1].x, axes[1].y, axes[1].z}, {2, 3}); },
            "(2, 3) S, m: half axes of the one-sigma ellipse in the tangent plane, longest first, or None.")
        .def_prop_ro("wrench", [](const Contact& c) {
            const Wrench& w = c.wrench;
            return make_array<double>({w.F.x, w.F.y, w.F.z, w.M.x, w.M.y, w.M.z}, {6}); },
            "(6,) the wrench it was computed from, S, N and N·m.")
        .def("__repr__", &repr);
}

}  // namespace contactbench::bindings
