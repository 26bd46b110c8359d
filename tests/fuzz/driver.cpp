// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <random>

#include "tests/fuzz/fuzz.h"

/// Our own driver for fuzz targets: needs no clang, and does the same every time.
///
///     fuzz_<name> [ROUNDS]               the seeds, then so many mutations of them (default 20000)
///     fuzz_<name> --seconds SECONDS      at least 20000, and more of the same ones until the time is over
///     fuzz_<name> FILE...                these inputs, to repeat a failure
///     fuzz_<name> --write-seeds DIRECTORY
namespace {

/// Inputs are a few kilobytes: whoever wants this much memory at once has believed a count.
constexpr std::size_t kLargestAllocation = std::size_t{128} << 20;
constexpr unsigned kSecondsPerInput = 20;

/// The input in hand, for the handlers of signals, which can get at nothing else.
const std::string* current_input = nullptr;

[[noreturn]] void fail(const char* why) {
    const char* name = "failed.input";
    (void)!write(2, why, std::strlen(why));
    const int file = current_input ? open(name, O_CREAT | O_TRUNC | O_WRONLY, 0644) : -1;
    if (file >= 0) {
        (void)!write(file, current_input->data(), current_input->size());
        const char* text = "\nthe input is in failed.input in this directory\n";
        (void)!write(2, text, std::strlen(text));
    }
    _exit(1);
}

void on_signal(int signal) {
    fail(signal == SIGALRM ? "an input takes too long" : signal == SIGABRT ? "aborted" : "crashed");
}

void run(const std::string& input) {
    current_input = &input;
    alarm(kSecondsPerInput);
    try {
        // A copy of exactly this size: reading past its end is seen by sanitizers.
        const std::vector<std::uint8_t> bytes(input.begin(), input.end());
        LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "unexpected exception: %s\n", error.what());
        fail("");
    }
    alarm(0);
    current_input = nullptr;
}

class Mutator {
  public:
    explicit Mutator(const std::vector<std::string>& seeds) : seeds_(seeds) {}

    std::string next() {
        std::string input = seeds_[below(seeds_.size())];
        for (std::size_t count = 1 + below(4); count > 0; --count)
            mutate(input);
        return input;
    }

  private:
    std::size_t below(std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random_() % n); }

    void overwrite(std::string& input, std::size_t at, std::string_view with) {
        if (at < input.size()) input.replace(at, std::min(with.size(), input.size() - at), with);
    }

    void mutate(std::string& input) {
        static const char* const words[] = {"nan",    "inf",        "-1",        "0",          "1e999",
                                            "-",      "4294967295", "100000000", "2147483648", "99999999999",
                                            "1e-320", "/",          "<"};
        static const std::uint64_t numbers[] = {0,          1,          0x7f,       0x80,       0xff,
                                                0xffff,     0x7fffffff, 0x80000000, 0xffffffff, 0x7f800000,
                                                0x7fc00000, 1u << 20,   1u << 28,   ~0ull,      1ull << 62};
        const std::size_t at = below(input.size()), length = 1 + below(16);
        switch (below(9)) {
            case 0:
                if (!input.empty()) input[at] = static_cast<char>(input[at] ^ (1 << below(8)));
                break;
            case 1:
                if (!input.empty()) input[at] = static_cast<char>(random_());
                break;
            case 2: {
                const std::uint64_t number = numbers[below(std::size(numbers))];
                const std::size_t size = std::size_t{1} << below(4);
                overwrite(input, at, {reinterpret_cast<const char*>(&number), size});
                break;
            }
            case 3:
                input.erase(at, length);
                break;
            case 4:
                input.insert(at, input.substr(below(input.size()), 4 * length));
                break;
            case 5:
                input.resize(at);
                break;
            case 6: {
                const std::string& other = seeds_[below(seeds_.size())];
                const std::size_t from = below(other.size());
                input.insert(at, other.substr(from, 8 * length));
                break;
            }
            case 7:
                replace_number(input, at, words[below(std::size(words))]);
                break;
            default:
                input.insert(at, words[below(std::size(words))]);
                break;
        }
    }

    /// Replaces, in a text, the number at or after a place.
    void replace_number(std::string& input, std::size_t at, const char* with) {
        const std::size_t begin = input.find_first_of("0123456789", at);
        if (begin == std::string::npos) return;
        const std::size_t end = std::min(input.find_first_not_of("0123456789.", begin), input.size());
        input.replace(begin, end - begin, with);
    }

    const std::vector<std::string>& seeds_;
    std::mt19937_64 random_{20240611};
};

int write_seeds(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    int number = 0;
    for (const std::string& seed : treefarm::fuzz::seeds())
        std::ofstream(folder / ("seed" + std::to_string(number++)), std::ios::binary) << seed;
    return 0;
}

std::string file_bytes(const char* name) {
    std::ifstream in(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void watch(std::size_t size) {
    if (size > kLargestAllocation && current_input)
        fail("an input makes the program allocate more than 128 MiB at once");
}

void* allocate(std::size_t size) {
    watch(size);
    void* memory = std::malloc(size > 0 ? size : 1);
    if (!memory) throw std::bad_alloc();
    return memory;
}

}  // namespace

void* operator new(std::size_t size) {
    return allocate(size);
}
void* operator new[](std::size_t size) {
    return allocate(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    watch(size);
    return std::malloc(size > 0 ? size : 1);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    std::free(memory);
}

// What libraries in C allocate is watched too, where no sanitizer has taken these functions for itself.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define __SANITIZE_ADDRESS__
#endif
#endif
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
    watch(size);
    return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
    if (size > 0 && count > kLargestAllocation / size) watch(kLargestAllocation + 1);
    return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
    watch(size);
    return __libc_realloc(memory, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
    watch(size);
    *memory = __libc_memalign(alignment, size);
    return *memory ? 0 : ENOMEM;
}
}
#endif

int main(int count, char** arguments) {
    if (count == 3 && std::strcmp(arguments[1], "--write-seeds") == 0) return write_seeds(arguments[2]);
    for (const int signal : {SIGALRM, SIGABRT, SIGSEGV, SIGFPE, SIGILL, SIGBUS})
        std::signal(signal, on_signal);

    int rounds = 20000;
    std::chrono::seconds least{0};
    if (count == 3 && std::strcmp(arguments[1], "--seconds") == 0) {
        least = std::chrono::seconds(std::atoi(arguments[2]));
    } else if (count == 2 && std::strspn(arguments[1], "0123456789") == std::strlen(arguments[1])) {
        rounds = std::atoi(arguments[1]);
    } else if (count > 1) {
        for (int i = 1; i < count; ++i)
            run(file_bytes(arguments[i]));
        return 0;
    }
    const std::vector<std::string> seeds = treefarm::fuzz::seeds();
    for (const std::string& seed : seeds) {
        run(seed);
        for (std::size_t size = 0; size < seed.size(); size += 1 + seed.size() / 1000)
            run(seed.substr(0, size));
    }
    Mutator mutator(seeds);
    const auto end = std::chrono::steady_clock::now() + least;
    int done = 0;
    for (; done < rounds || std::chrono::steady_clock::now() < end; ++done)
        run(mutator.next());
    std::printf("%zu seeds, %d mutations\n", seeds.size(), done);
    return 0;
}
