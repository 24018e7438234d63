// The test vectors of a bundle: samples, and the answers that a runtime must give to them; see docs/bundle.md.
#pragma once

#include <string>

namespace contactbench::runtime {

// Throws LoadError: CB_ERROR_SELF_TEST where there are none, or the answers are others.
void replay_self_test(const std::string& folder);

}  // namespace contactbench::runtime
