#include <algorithm>
#include <cmath>
#include <complex>

#include "shape.hpp"
#include "physics.hpp"

namespace contactbench::runtime {

namespace {

constexpr double slowest = 1e-6;  // of the rate: slower has no sections that doubles can hold
constexpr double apart = 1e-12;
constexpr const char* field = "filters.location.sections";

using Complex = std::complex<double>;

// A pair of poles over two zeros; every zero is at -1, or at 0.
Section section_of(double a1, double a2, int at_minus_one) {
    const double zeros[3][3] = {{1, 0, 0}, {1, 1, 0}, {1, 2, 1}};
    Section s;
    std::copy(zeros[at_minus_one], zeros[at_minus_one] + 3, s.b);
    s.a[1] = a1, s.a[2] = a2;
    return s;
}

// Butterworth by the bilinear transform, in SciPy's order: the poles nearest to the unit circle last, each with the
// zeros nearest to them; an odd order has a pole and a zero at 0 more; the gain is in the first section.
std::vector<Section> butterworth(double rate, double cutoff, int order) {
    const double w = std::tan(M_PI * cutoff / rate);
    std::vector<Section> sections;
    Complex below = 1.0;
    bool zero_left = order % 2 == 1;
    for (int m = order - 1; m > 0; m -= 2) {
        const Complex s = -w * std::polar(1.0, M_PI * m / (2.0 * order));
        const Complex z = (1.0 + s) / (1.0 - s);
        const bool takes_zero = zero_left && std::abs(z) < std::abs(z + 1.0);
        zero_left = zero_left && !takes_zero;
        sections.push_back(section_of(-2.0 * z.real(), std::norm(z), takes_zero ? 1 : 2));
        below *= (1.0 - s) * std::conj(1.0 - s);
    }
    if (order % 2 == 1) {
        sections.push_back(section_of(-(1.0 - w) / (1.0 + w), 0.0, zero_left ? 1 : 2));
        below *= 1.0 + w;
    }
    std::reverse(sections.begin(), sections.end());
    for (double& b : sections[0].b) b *= std::pow(w, order) / below.real();
    return sections;
}

bool near(const double* told, const double* wanted) {
    for (int i = 0; i < 3; ++i)
        if (!(std::fabs(told[i] - wanted[i]) <= apart)) return false;
    return true;
}

}  // namespace

void check_low_pass(const std::vector<Section>& sections, double rate, double cutoff, int order) {
    if (!(cutoff < rate / 2)) refuse("filters.location.cutoff_Hz", "not below half the rate");
    if (cutoff < slowest * rate) refuse("filters.location.cutoff_Hz", "too slow for the rate");
    const std::vector<Section> wanted = butterworth(rate, cutoff, order);
    if (sections.size() != wanted.size()) refuse(field, "not as many as the order asks for");
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const Section& s = sections[i];
        if (s.a[0] != 1.0 || !(std::fabs(s.a[2]) < 1.0) || !(std::fabs(s.a[1]) < 1.0 + s.a[2]))
            refuse(field, "a0 is not 1, or the filter is unstable");
        if (!near(s.b, wanted[i].b) || !near(s.a, wanted[i].a))
            refuse(field, "not those of cutoff_Hz, order and rate_Hz");
    }
}

}  // namespace contactbench::runtime
