// A sensor's frames through the C library, as a controller would do it.
//
//   chain sealed BUNDLE FRAMES [fault]    all updates where any system call kills the process; counts what was asked of
//                                         the heap and of locks. `fault` is made on purpose: malloc, lock or syscall.
//   chain run BUNDLE FRAMES COUNT PERIOD_NS CORE OTHER_CORE TIMES URGENT
//                                         frames by UDP, each decoded, located and published by UDP; TIMES gets five
//                                         int64 a frame. Period 0: the next frame follows the last contact. URGENT 1:
//                                         with real-time priority, if permitted.
//
// FRAMES: an RDT record (36 bytes, big endian, a million counts a unit) and R_WS (9 doubles) each; repeated as needed.
#include <arpa/inet.h>
#include <dlfcn.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "contactbench_runtime.h"
#include "counted_heap.hpp"

namespace {
long locks = 0;
}

// These stand in front of the C library's own for the whole process.
extern "C" {
#define COUNTED(name, type)                                                           \
    int name(type* lock) noexcept {                                                   \
        static const auto real = reinterpret_cast<int (*)(type*)>(dlsym(RTLD_NEXT, #name)); \
        return locks += counting, real(lock);                                         \
    }
COUNTED(pthread_mutex_lock, pthread_mutex_t)
COUNTED(pthread_mutex_trylock, pthread_mutex_t)
COUNTED(pthread_rwlock_rdlock, pthread_rwlock_t)
COUNTED(pthread_rwlock_wrlock, pthread_rwlock_t)
}

namespace {

constexpr int record_bytes = 36;
constexpr double counts_per_unit = 1e6, sample_s = 1e-3;

struct Frame {
    unsigned char record[record_bytes];
    double R_WS[9];
};

struct Times {  // ns of the monotonic clock; `used`: of this thread's processor time, from `received` to `published`
    std::int64_t sent, received, located, published, used;
};

[[noreturn]] void fail(const char* what) {
    std::perror(what);
    std::exit(2);
}

std::int64_t now(clockid_t clock = CLOCK_MONOTONIC) {
    timespec t;
    clock_gettime(clock, &t);
    return t.tv_sec * 1000000000LL + t.tv_nsec;
}

std::uint32_t number_at(const unsigned char* p) {
    return std::uint32_t(p[0]) << 24 | std::uint32_t(p[1]) << 16 | std::uint32_t(p[2]) << 8 | p[3];
}

void put_number(std::uint32_t n, unsigned char* p) {
    for (int i = 0; i < 4; ++i) p[i] = static_cast<unsigned char>(n >> (24 - 8 * i));
}

void decode(const unsigned char* record, double wrench[6]) {
    for (int i = 0; i < 6; ++i) wrench[i] = std::int32_t(number_at(record + 12 + 4 * i)) / counts_per_unit;
}

std::vector<Frame> read_frames(const char* path) {
    std::vector<Frame> frames;
    std::FILE* file = std::fopen(path, "rb");
    if (!file) fail(path);
    unsigned char bytes[record_bytes + sizeof Frame::R_WS];
    while (std::fread(bytes, sizeof bytes, 1, file) == 1) {
        Frame& f = frames.emplace_back();
        std::memcpy(f.record, bytes, record_bytes);
        std::memcpy(f.R_WS, bytes + record_bytes, sizeof f.R_WS);
    }
    std::fclose(file);
    if (frames.empty()) fail("no frames");
    return frames;
}

cb_runtime* opened(const char* bundle) {
    cb_error error = CB_ERROR_INIT;
    cb_runtime* runtime = cb_open(bundle, &error);
    if (!runtime) std::fprintf(stderr, "%s\n", error.message), std::exit(2);
    return runtime;
}

void pin(int core) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(core, &set);
    if (sched_setaffinity(0, sizeof set, &set) != 0) fail("core");
}

// ---- sealed -----------------------------------------------------------------------------------

// Not even exit_group is allowed: exit ends the one thread there is.
[[noreturn]] void leave(int code) {
    syscall(SYS_exit, code);
    __builtin_trap();
}

int sealed(const char* bundle, const char* path, const std::string& fault) {
    cb_runtime *plain = opened(bundle), *tracked = opened(bundle);
    const std::vector<Frame> frames = read_frames(path);
    cb_contact contact = CB_CONTACT_INIT;
    cb_zero zero = CB_ZERO_INIT;
    long accepted = 0, tracked_accepted = 0;
    pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&mutex), pthread_mutex_unlock(&mutex);  // found now, not where nothing may be looked up
    void* (*volatile get)(size_t) = malloc;  // or the compiler leaves it out
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) return std::perror("seccomp"), 3;
    counting = true;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double time = double(i + 1) * sample_s;
        cb_sample sample = CB_SAMPLE_INIT;
        decode(frames[i].record, sample.wrench);
        sample.time = sample.arrival = time;
        cb_update(plain, sample.wrench, frames[i].R_WS, time, &contact);
        accepted += contact.accepted;
        if (i % 10 == 0) cb_pose(tracked, frames[i].R_WS, nullptr, time);
        cb_update_sample(tracked, &sample, &contact);
        tracked_accepted += contact.accepted;
        cb_check(tracked, time, &contact);
        cb_check_zero(tracked, &zero);
    }
    cb_reset(plain);
    if (fault == "malloc") get(8);
    if (fault == "lock") pthread_mutex_lock(&mutex);
    if (fault == "syscall") syscall(SYS_getppid);
    counting = false;
    char text[200];
    const int n = std::snprintf(text, sizeof text,
                                "{\"updates\":%zu,\"accepted\":%ld,\"tracked\":%ld,\"requests\":%ld,\"locks\":%ld}\n",
                                frames.size(), accepted, tracked_accepted, requests, locks);
    leave(write(1, text, std::size_t(n)) == n && requests == 0 && locks == 0 ? 0 : 1);
}

// ---- run --------------------------------------------------------------------------------------

int bound(sockaddr_in& address) {
    const int s = socket(AF_INET, SOCK_DGRAM, 0);
    address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    if (s < 0 || bind(s, reinterpret_cast<sockaddr*>(&address), length) != 0 ||
        getsockname(s, reinterpret_cast<sockaddr*>(&address), &length) != 0)
        fail("socket");
    return s;
}

void join(int s, const sockaddr_in& address) {
    if (connect(s, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) fail("connect");
}

// The sensor, which also reads the contacts. Returns how many of those came.
long sense(int s, const std::vector<Frame>& frames, long count, std::int64_t period, Times* times) {
    cb_contact contact;
    long came = 0;
    std::int64_t due = now() + 50000000;
    for (long i = 0; i < count; ++i, due += period) {
        if (period > 0) {
            const timespec at{due / 1000000000, due % 1000000000};
            clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
        }
        Frame frame = frames[std::size_t(i) % frames.size()];
        put_number(std::uint32_t(i), frame.record);  // what is lost is known by it
        times[i].sent = now();
        if (send(s, frame.record, record_bytes, 0) != record_bytes) fail("send");
        if (period == 0) came += recv(s, &contact, sizeof contact, 0) == sizeof contact;
        while (period > 0 && recv(s, &contact, sizeof contact, MSG_DONTWAIT) == sizeof contact) ++came;
    }
    timeval patience{0, 200000};
    setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    while (recv(s, &contact, sizeof contact, 0) == sizeof contact) ++came;
    return came;
}

int run(char** argv) {
    const std::vector<Frame> frames = read_frames(argv[1]);
    const long count = std::atol(argv[2]);
    const std::int64_t period = std::atoll(argv[3]);
    cb_runtime* runtime = opened(argv[0]);
    const std::size_t bytes = std::size_t(count) * sizeof(Times) + sizeof(long);
    void* shared = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
    if (shared == MAP_FAILED) fail("mmap");
    auto* times = static_cast<Times*>(shared);
    auto* came = reinterpret_cast<long*>(times + count);
    sockaddr_in to_chain, to_sensor;
    const int in = bound(to_chain), far = bound(to_sensor);
    join(in, to_sensor), join(far, to_chain);
    const pid_t sensor = fork();
    if (sensor == 0) {
        pin(std::atoi(argv[5]));
        *came = sense(far, frames, count, period, times);
        _exit(0);
    }
    pin(std::atoi(argv[4]));
    const sched_param priority{50};
    const bool urgent = std::atoi(argv[7]) != 0 && sched_setscheduler(0, SCHED_FIFO, &priority) == 0;
    mlockall(MCL_CURRENT | MCL_FUTURE);
    // A frame that is lost must not keep this waiting for ever.
    timeval patience{5, 0};
    setsockopt(in, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    cb_contact contact = CB_CONTACT_INIT;
    long done = 0;
    rusage before, after;
    getrusage(RUSAGE_THREAD, &before);
    for (std::size_t number = 0; long(number) + 1 < count; ++done) {
        unsigned char record[record_bytes];
        if (recv(in, record, sizeof record, 0) != record_bytes) break;
        const std::int64_t used = now(CLOCK_THREAD_CPUTIME_ID), received = now();
        number = number_at(record);
        if (number >= std::size_t(count)) break;
        Times& t = times[number];
        t.received = received;
        double wrench[6];
        decode(record, wrench);
        const double time = double(number + 1) * sample_s;
        cb_update(runtime, wrench, frames[number % frames.size()].R_WS, time, &contact);
        t.located = now();
        if (send(in, &contact, sizeof contact, 0) != sizeof contact) fail("publish");
        t.published = now();
        t.used = now(CLOCK_THREAD_CPUTIME_ID) - used;
    }
    getrusage(RUSAGE_THREAD, &after);
    waitpid(sensor, nullptr, 0);
    std::FILE* file = std::fopen(argv[6], "wb");
    if (!file || std::fwrite(times, sizeof(Times), std::size_t(count), file) != std::size_t(count) || std::fclose(file))
        fail(argv[6]);
    std::printf("{\"done\":%ld,\"came\":%ld,\"faults\":%ld,\"switched\":%ld,\"urgent\":%d}\n", done, *came,
                after.ru_minflt - before.ru_minflt, after.ru_nivcsw - before.ru_nivcsw, urgent);
    cb_close(runtime);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string mode = argc > 1 ? argv[1] : "";
    if (mode == "sealed" && (argc == 4 || argc == 5)) return sealed(argv[2], argv[3], argc == 5 ? argv[4] : "");
    if (mode == "run" && argc == 10) return run(argv + 2);
    std::fputs("usage: see the head of chain.cpp\n", stderr);
    return 2;
}
