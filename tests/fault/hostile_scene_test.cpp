// SPDX-License-Identifier: Apache-2.0
// Scenes that mean harm: a clear error, in bounded time and memory.
#include <sys/resource.h>
#include <sys/stat.h>

#include "common/base/error.h"
#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

class HostileScene : public test::MitsubaFixture {
  protected:
    /// Bounded memory: what allocates more fails with bad_alloc, and with it the test.
    void SetUp() override {
        MitsubaFixture::SetUp();
        getrlimit(RLIMIT_DATA, &before_);
        rlimit limit = before_;
        limit.rlim_cur = rlim_t{1} << 30;
        setrlimit(RLIMIT_DATA, &limit);
    }
    void TearDown() override { setrlimit(RLIMIT_DATA, &before_); }

    /// The error's one line; empty if the scene is read.
    std::string refusal(const std::string& body) const {
        try {
            load_with_sensor(body);
        } catch (const InputError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
            return error.what();
        }
        return "";
    }

    /// Every way in which a scene names a file.
    static std::vector<std::string> users_of(const std::string& file) {
        const std::string name = "<string name=\"filename\" value=\"" + file + "\"/>";
        const std::string texture = "<texture type=\"bitmap\" name=\"reflectance\">" + name + "</texture>";
        return {"<shape type=\"obj\">" + name + "</shape>",
                "<shape type=\"ply\">" + name + "</shape>",
                "<shape type=\"serialized\">" + name + "</shape>",
                "<shape type=\"sphere\"><bsdf type=\"diffuse\">" + texture + "</bsdf></shape>",
                "<emitter type=\"envmap\">" + name + "</emitter>",
                "<shape type=\"sphere\"><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" filename=\"" + file +
                    "\"/></bsdf></shape>",
                "<include filename=\"" + file + "\"/>"};
    }

  private:
    rlimit before_{};
};

TEST_F(HostileScene, FilesThatNeverEndOrAreNone) {
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    for (const std::string& file : {std::string("/dev/zero"), std::string("/dev/stdin"), std::string("pipe"),
                                    std::string("sub"), std::string("/proc/self/mem")})
        for (const std::string& user : users_of(file))
            EXPECT_NE(refusal(user), "") << user;
}

/// Absolute paths and ".." are allowed, as in Mitsuba: what is no scene's file is named and refused.
TEST_F(HostileScene, FilesOutsideItsFolder) {
    for (const std::string& file : {std::string("/etc/passwd"), std::string("../../../../../../etc/passwd")})
        for (const std::string& user : users_of(file)) {
            const std::string message = refusal(user);
            EXPECT_NE(message.find("passwd"), std::string::npos) << user << message;
            EXPECT_LT(message.size(), 400u) << message;
        }
}

TEST_F(HostileScene, CountsThatNobodyHas) {
    write(
        "a.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1000000000\nproperty list uchar int vertex_indices\nend_header\n");
    EXPECT_NE(refusal("<shape type=\"ply\"><string name=\"filename\" value=\"a.ply\"/></shape>").find("a.ply"),
              std::string::npos);
    write("b.ply",
          "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 1000000000\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n");
    EXPECT_NE(refusal("<shape type=\"ply\"><string name=\"filename\" value=\"b.ply\"/></shape>"), "");
    write("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 1000000000\n");
    EXPECT_NE(refusal("<shape type=\"obj\"><string name=\"filename\" value=\"c.obj\"/></shape>").find("c.obj:4:"),
              std::string::npos);
    EXPECT_NE(refusal("<emitter type=\"sky\"><integer name=\"resolution\" value=\"1000000000\"/></emitter>"), "");
    for (const char* size : {"0", "-5", "65536", "4000000000", "99999999999999999999"})
        EXPECT_THROW(load(test::sensor("").replace(test::sensor("").find("200"), 3, size)), InputError) << size;
}

TEST_F(HostileScene, NestingWithoutEnd) {
    std::string deep;
    for (int i = 0; i < 200'000; ++i)
        deep += "<bsdf type=\"twosided\">";
    EXPECT_NE(refusal(deep), "") << "cut short";
    for (int i = 0; i < 200'000; ++i)
        deep += "</bsdf>";
    EXPECT_NE(refusal(deep), "");
    EXPECT_NE(refusal("<shape type=\"sphere\" id=\"a\"><ref id=\"a\"/></shape>"), "");
    EXPECT_NE(refusal("<bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf><bsdf type=\"twosided\" id=\"b\"><ref "
                      "id=\"a\"/></bsdf><shape type=\"sphere\"><ref id=\"a\"/></shape>"),
              "");
}

TEST_F(HostileScene, TextThatGrows) {
    // A billion laughs: entities of a document type are not expanded.
    std::string laughs = "<!DOCTYPE scene [<!ENTITY a0 \"ha\">";
    for (int i = 1; i < 30; ++i)
        laughs +=
            "<!ENTITY a" + std::to_string(i) + " \"&a" + std::to_string(i - 1) + ";&a" + std::to_string(i - 1) + ";\">";
    laughs += "]>\n<scene version=\"3.0.0\"><string name=\"x\" value=\"&a29;\"/></scene>";
    EXPECT_THROW(load_scene(write("laughs.xml", laughs)), InputError);
    // Definitions that name each other.
    std::string defaults;
    for (int i = 0; i < 60; ++i)
        defaults += "<default name=\"d" + std::to_string(i + 1) + "\" value=\"$d" + std::to_string(i) + "$d" +
                    std::to_string(i) + "\"/>";
    EXPECT_NE(refusal("<default name=\"d0\" value=\"ha\"/>" + defaults + "<shape type=\"$d60\"/>"), "");
}

}  // namespace
}  // namespace treefarm
