// SPDX-License-Identifier: Apache-2.0
#include "common/comm/join_ticket.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "common/base/error.h"
#include "tests/support/refusal.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

JoinTicket small_ticket() {
    return {draw_join_run(), "::1", 4711, draw_join_key()};
}

std::string refusal(const std::function<void()>& act) {
    return test::refusal_of([&] { act(); });
}

TEST(JoinTicket, IsReadAsItWasWrittenByItsOwnerAlone) {
    const fs::path path = test::fresh_test_folder() / "join";
    const mode_t before = umask(0);
    for (int k = 0; k < 2; ++k) {  // the second replaces the first
        const JoinTicket written = small_ticket();
        write_ticket(path, written);
        EXPECT_EQ(read_ticket(path), written);
        struct stat status {};
        ASSERT_EQ(stat(path.c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 0777, 0600u);
    }
    umask(before);
    EXPECT_EQ(std::distance(fs::directory_iterator(path.parent_path()), {}), 1) << "no temporary file stays";
}

TEST(JoinTicket, OneThatOthersCanReadIsRefused) {
    const fs::path path = test::fresh_test_folder() / "join";
    write_ticket(path, small_ticket());
    fs::permissions(path, fs::perms::group_read, fs::perm_options::add);
    EXPECT_NE(refusal([&] { read_ticket(path); }).find("can be read by other users"), std::string::npos);
    EXPECT_NE(refusal([&] { read_ticket(path.parent_path()); }).find("is no file"), std::string::npos);
    EXPECT_NE(refusal([&] { read_ticket(path.parent_path() / "none"); }).find("cannot be read"), std::string::npos);
}

TEST(JoinTicket, OneThatIsCutOrChangedIsRefusedOrAnother) {
    const JoinTicket whole = small_ticket();
    const std::string text = ticket_text(whole);
    EXPECT_EQ(parse_ticket(text, "join"), whole);
    for (std::size_t length = 0; length + 1 < text.size(); ++length)
        EXPECT_NE(refusal([&] { parse_ticket(text.substr(0, length), "join"); }), "") << length;
    for (std::size_t at = 0; at < text.size(); ++at) {
        std::string changed = text;
        changed[at] = '!';
        const std::string why = refusal([&] { EXPECT_NE(parse_ticket(changed, "join"), whole) << at; });
        EXPECT_TRUE(why.empty() || why.find("join: is no ticket") != std::string::npos) << why;
    }
}

TEST(JoinTicket, SecretsDiffer) {
    EXPECT_NE(draw_join_key(), draw_join_key());
    EXPECT_NE(draw_join_run(), draw_join_run());
}

}  // namespace
}  // namespace treefarm
