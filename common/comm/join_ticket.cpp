// SPDX-License-Identifier: Apache-2.0
#include "common/comm/join_ticket.h"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <sstream>

#include "common/base/descriptor.h"
#include "common/base/error.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFirstLine = "treefarm join 1";
constexpr std::size_t kMostTicketBytes = 4096;
constexpr int kBase64 = sodium_base64_VARIANT_ORIGINAL;

template <std::size_t N>
std::array<std::uint8_t, N> draw_bytes() {
    if (sodium_init() < 0) throw RunError("libsodium finds no source of random numbers");
    std::array<std::uint8_t, N> bytes;
    randombytes_buf(bytes.data(), bytes.size());
    return bytes;
}

template <std::size_t N>
std::string base64(const std::array<std::uint8_t, N>& bytes) {
    char text[sodium_base64_ENCODED_LEN(N, sodium_base64_VARIANT_ORIGINAL)];
    sodium_bin2base64(text, sizeof text, bytes.data(), bytes.size(), kBase64);
    return text;
}

template <std::size_t N>
bool from_base64(const std::string& text, std::array<std::uint8_t, N>& bytes) {
    std::size_t length = 0;
    return sodium_base642bin(bytes.data(), bytes.size(), text.data(), text.size(), nullptr, &length, nullptr,
                             kBase64) == 0 &&
           length == N;
}

[[noreturn]] void refuse(const std::string& file, const std::string& what) {
    throw InputError(Location{file, 0, 0}, what,
                     "name the run directory, or a copy of its file join, of a render with farm.join = true");
}

[[noreturn]] void fail(const fs::path& path) {
    throw RunError(path.string() + ": cannot be written: " + std::strerror(errno));
}

/// The secret is one only where nobody else could read it.
void check_owner(const fs::path& path, const struct stat& status) {
    if (!S_ISREG(status.st_mode)) refuse(path.string(), "is no file");
    if (status.st_uid != ::geteuid())
        throw InputError(Location{path.string(), 0, 0}, "belongs to another user, who may have made it up",
                         "join as the user who renders");
    if ((status.st_mode & 077) != 0)
        throw InputError(Location{path.string(), 0, 0}, "can be read by other users, and holds a secret",
                         "chmod 600 it, and start the render again if somebody may have read it");
}

}  // namespace

JoinKey draw_join_key() {
    return draw_bytes<sizeof(JoinKey)>();
}

JoinRun draw_join_run() {
    return draw_bytes<sizeof(JoinRun)>();
}

std::string ticket_text(const JoinTicket& ticket) {
    return std::string(kFirstLine) + "\nrun " + base64(ticket.run) + "\naddress " + ticket.address + "\nport " +
           std::to_string(ticket.port) + "\nsecret " + base64(ticket.secret) + "\n";
}

JoinTicket parse_ticket(const std::string& text, const std::string& file) {
    std::istringstream lines(text);
    const auto value = [&](const std::string& name) {
        std::string line;
        if (!std::getline(lines, line) || !line.starts_with(name + " "))
            refuse(file, "is no ticket: \"" + name + "\" is missing");
        return line.substr(name.size() + 1);
    };
    std::string first;
    if (!std::getline(lines, first) || first != kFirstLine)
        refuse(file, "is no ticket: it does not begin with \"" + std::string(kFirstLine) + "\"");
    JoinTicket ticket;
    if (!from_base64(value("run"), ticket.run)) refuse(file, "is no ticket: its run is none");
    ticket.address = value("address");
    const std::string port = value("port");
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), ticket.port);
    if (error != std::errc() || end != port.data() + port.size() || ticket.port == 0)
        refuse(file, "is no ticket: its port is none");
    if (!from_base64(value("secret"), ticket.secret)) refuse(file, "is no ticket: its secret is none");
    return ticket;
}

void write_ticket(const fs::path& path, const JoinTicket& ticket) {
    const std::string text = ticket_text(ticket);
    const auto random = draw_bytes<6>();
    char letters[2 * sizeof random + 1];  // what is_temporary_of() knows: a killed run's are removed by the next
    sodium_bin2hex(letters, sizeof letters, random.data(), random.size());
    fs::path temporary = path;
    temporary += std::string(".tmp-") + letters;
    {
        const Descriptor file = Descriptor::open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
        if (!file) fail(path);
        // The umask may have taken from the owner, and some file systems give everybody everything.
        struct stat status {};
        const bool whole = ::fchmod(file.fd(), 0600) == 0 &&
                           ::write(file.fd(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                           ::fstat(file.fd(), &status) == 0;
        if (!whole || (status.st_mode & 077) != 0) {
            if (whole) errno = EPERM;
            const int error = errno;
            ::unlink(temporary.c_str());
            errno = error;
            fail(path);
        }
    }
    if (::rename(temporary.c_str(), path.c_str()) != 0) {
        const int error = errno;
        ::unlink(temporary.c_str());
        errno = error;
        fail(path);
    }
}

JoinTicket read_ticket(const fs::path& path) {
    const Descriptor file = Descriptor::open(path, O_RDONLY | O_NONBLOCK);
    struct stat status {};
    if (!file || ::fstat(file.fd(), &status) != 0)
        refuse(path.string(), std::string("cannot be read: ") + std::strerror(errno));
    check_owner(path, status);
    std::string text(kMostTicketBytes, '\0');
    const ssize_t length = ::read(file.fd(), text.data(), text.size());
    if (length < 0) refuse(path.string(), std::string("cannot be read: ") + std::strerror(errno));
    text.resize(static_cast<std::size_t>(length));
    return parse_ticket(text, path.string());
}

}  // namespace treefarm
