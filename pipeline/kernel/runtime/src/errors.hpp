// What a loader throws; the C boundary turns it into a cb_error.
#pragma once

#include <stdexcept>
#include <string>

#include "contactbench_runtime.h"

namespace contactbench::runtime {

class LoadError : public std::runtime_error {
public:
    LoadError(int code, const std::string& message) : std::runtime_error(message), code_(code) {}
    int code() const { return code_; }

private:
    int code_;
};

}  // namespace contactbench::runtime
