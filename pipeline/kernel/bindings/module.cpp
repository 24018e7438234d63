// The extension module: contact sensing for Python. Arrays in, answers out; the work is in the headers.
#include "bindings.hpp"

NB_MODULE(CONTACTBENCH_MODULE, m) {
    m.doc() = "Contact location from a wrench and a mesh: the compiled core of contactbench.pipeline.contact.";
    m.attr("variant") = CONTACTBENCH_VARIANT;
    m.attr("compiler") = __VERSION__;
    contactbench::bindings::bind_contact(m);
    contactbench::bindings::bind_solvers(m);
    contactbench::bindings::bind_surface(m);
    contactbench::bindings::bind_geodesic(m);
    contactbench::bindings::bind_collapse(m);
    contactbench::bindings::bind_runtime(m);
    contactbench::bindings::bind_table(m);
}
