#include "folder.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

namespace contactbench::runtime {

namespace {

constexpr const char* needed[] = {config_name, checksum_name, "probe.ply", planes_name, ros2_name};
constexpr const char* optional[] = {ft_calib_name, self_test_name, "report.html"};
constexpr off_t largest_config = 1 << 20, largest_file = 200 << 20;
constexpr int tries = 100;

bool known(const std::string& name) {
    const auto is = [&](const char* other) { return name == other; };
    return std::any_of(std::begin(needed), std::end(needed), is) ||
           std::any_of(std::begin(optional), std::end(optional), is);
}

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    int get() const { return number_; }
    int release() { return std::exchange(number_, -1); }
    explicit operator bool() const { return number_ >= 0; }

private:
    int number_;
};

Descriptor open_folder(const std::string& path) {
    return Descriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
}

std::string read_file(int folder, const std::string& name) {
    // Not through links, and no pipes or devices: what is read must end.
    const Descriptor file(::openat(folder, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat status {};
    if (!file || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode))
        refuse_file(CB_ERROR_FILE, name, "no plain file that can be opened");
    if (status.st_size > (name == config_name ? largest_config : largest_file))
        refuse_file(CB_ERROR_FILE, name, "too large");
    std::string data(std::size_t(status.st_size) + 1, '\0');  // one more: it must end where it said
    std::size_t have = 0;
    while (have < data.size()) {
        const ssize_t n = ::read(file.get(), data.data() + have, data.size() - have);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) break;
        have += std::size_t(n);
    }
    if (have + 1 != data.size()) refuse_file(CB_ERROR_FILE, name, "cannot be read to its end");
    data.pop_back();
    return data;
}

std::vector<std::string> list(int folder, const std::string& path) {
    Descriptor again(::openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    const std::unique_ptr<DIR, int (*)(DIR*)> entries(again ? ::fdopendir(again.get()) : nullptr, ::closedir);
    if (!entries) throw LoadError(CB_ERROR_FILE, path + ": cannot be listed; check its permissions");
    again.release();
    std::vector<std::string> names;
    for (;;) {
        errno = 0;
        const dirent* entry = ::readdir(entries.get());
        if (!entry) break;
        const std::string name = entry->d_name;
        if (name == "." || name == "..") continue;
        if (!known(name)) throw LoadError(CB_ERROR_FILE, name.substr(0, 100) + ": does not belong in a bundle; remove it");
        names.push_back(name);
    }
    if (errno != 0) throw LoadError(CB_ERROR_FILE, path + ": cannot be listed; check its permissions");
    return names;
}

// By the opened folder, whatever its name stands for by now.
Files read_all(int folder, const std::string& path) {
    Files files;
    for (const std::string& name : list(folder, path)) files[name] = read_file(folder, name);
    for (const char* name : needed)
        if (!files.count(name)) refuse_file(CB_ERROR_FILE, name, "missing");
    return files;
}

bool still_there(int folder, const std::string& path) {
    struct stat opened {}, named {};
    return ::fstat(folder, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
           opened.st_dev == named.st_dev;
}

// Where an export puts the old folder while it cannot exchange two names at once.
std::string aside(const std::string& folder) {
    std::filesystem::path path(folder);
    if (!path.has_filename()) path = path.parent_path();
    std::string name = ".";
    name += path.filename().string();
    name += ".aside";
    return path.replace_filename(name).string();
}

}  // namespace

void refuse_file(int code, const std::string& file, const std::string& what) {
    throw LoadError(code, file + ": " + what + "; copy or export the bundle again");
}

Files read_folder(const std::string& folder) {
    const std::string other = aside(folder);
    for (int left = tries;; --left) {
        struct stat status {};
        const bool away = ::lstat(folder.c_str(), &status) != 0 && ::stat(other.c_str(), &status) == 0;
        const std::string& path = away ? other : folder;
        const Descriptor opened = open_folder(path);
        try {
            if (opened) return read_all(opened.get(), path);
            if (::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode))
                throw LoadError(CB_ERROR_FILE, folder + ": a file, not a folder; unpack it: python3 -m zipfile -e FILE FOLDER");
            throw LoadError(CB_ERROR_FILE, folder + ": no such folder; give the folder of a bundle, unpacked");
        } catch (const LoadError&) {
            // An export may have put another in its place and emptied this one, or be about to.
            const bool gone = opened ? !still_there(opened.get(), path) : away || ::stat(path.c_str(), &status) == 0;
            if (left == 0 || !gone || (!opened && !S_ISDIR(status.st_mode))) throw;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

}  // namespace contactbench::runtime
