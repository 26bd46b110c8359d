// SPDX-License-Identifier: Apache-2.0
#include "serve/token.h"

#include <sys/random.h>

#include <array>
#include <cerrno>
#include <fstream>

#include "common/base/error.h"

namespace treefarm {

namespace {

constexpr const char* kHexadecimal = "0123456789abcdef";
constexpr std::size_t kLeast = 16, kMost = 256;

/// Whether a character needs no escape in a URL (RFC 3986, "unreserved").
bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
           c == '.' || c == '~';
}

}  // namespace

std::string make_token() {
    std::array<unsigned char, 16> random{};
    for (std::size_t have = 0; have < random.size();) {
        const ssize_t got = getrandom(random.data() + have, random.size() - have, 0);
        if (got < 0 && errno != EINTR) throw RunError("the system gives no random bytes for a token");
        if (got > 0) have += static_cast<std::size_t>(got);
    }
    std::string token;
    for (const unsigned char byte : random) {
        token += kHexadecimal[byte >> 4];
        token += kHexadecimal[byte & 15];
    }
    return token;
}

std::string read_token(const std::filesystem::path& file) {
    const auto refuse = [&](const std::string& what) {
        throw InputError(Location{file.string(), 0, 0}, what,
                         "write one line of 16 to 256 letters and digits into it, for instance what openssl rand -hex "
                         "16 says");
    };
    std::ifstream stream(file);
    std::string token, more;
    if (!stream) refuse("cannot be read");
    std::getline(stream, token);
    if (token.ends_with('\r')) token.pop_back();
    while (std::getline(stream, more))
        if (!more.empty()) refuse("has more than one line");
    if (token.size() < kLeast || token.size() > kMost) refuse("holds no token of 16 to 256 characters");
    for (const char c : token)
        if (!is_plain(c)) refuse("holds a token with characters that a URL cannot have");
    return token;
}

bool equal_in_constant_time(const std::string& given, const std::string& secret) {
    if (secret.empty()) return false;
    unsigned char differences = given.size() == secret.size() ? 0 : 1;
    for (std::size_t k = 0; k < given.size(); ++k)
        differences = static_cast<unsigned char>(differences | (static_cast<unsigned char>(given[k]) ^
                                                                static_cast<unsigned char>(secret[k % secret.size()])));
    return differences == 0;
}

bool is_loopback(const std::string& address) {
    return address == "localhost" || address == "::1" ||
           (address.starts_with("127.") && address.find_first_not_of("0123456789.") == std::string::npos);
}

bool names_loopback(const std::string& host_header) {
    if (host_header.starts_with('[')) return is_loopback(host_header.substr(1, host_header.find(']') - 1));
    return is_loopback(host_header.substr(0, host_header.find(':')));
}

}  // namespace treefarm
