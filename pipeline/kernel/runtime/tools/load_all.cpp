// contactbench-load_all FOLDER: loads every folder in it as a bundle, and says how each went:
//   NAME refused CODE MESSAGE   or   NAME loaded
// and on standard error how long the slowest took:   slowest NAME 0.012 s
// A bundle that loads is also run for some samples. For mutated bundles under the sanitizers.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "contactbench_runtime.h"

namespace {

void run(cb_runtime* runtime) {
    const double level[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    cb_contact contact = CB_CONTACT_INIT;
    for (int i = 0; i < 200; ++i) {
        const double wrench[6] = {0.01 * i, 0.3, -0.1 * i, 0.001 * i, -0.02, 0.003};
        cb_update(runtime, wrench, level, 0.001 * i, &contact);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: contactbench-load_all FOLDER\n", stderr);
        return 2;
    }
    std::vector<std::filesystem::path> folders;
    std::error_code failed;
    for (std::filesystem::directory_iterator i(argv[1], failed), end; !failed && i != end; i.increment(failed))
        folders.push_back(i->path());
    if (failed) {
        std::fprintf(stderr, "%s: cannot be listed\n", argv[1]);
        return 2;
    }
    std::sort(folders.begin(), folders.end());
    std::string slowest = "none";
    double longest = 0.0;
    for (const auto& folder : folders) {
        cb_error error = CB_ERROR_INIT;
        const auto begin = std::chrono::steady_clock::now();
        cb_runtime* runtime = cb_open(folder.c_str(), &error);
        const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const std::string name = folder.filename().string();
        if (took > longest) longest = took, slowest = name;
        if (runtime) {
            run(runtime);
            std::printf("%s loaded\n", name.c_str());
        } else {
            std::printf("%s refused %d %s\n", name.c_str(), int(error.code), error.message);
        }
        cb_close(runtime);
    }
    std::fprintf(stderr, "slowest %s %.3f s\n", slowest.c_str(), longest);
}
