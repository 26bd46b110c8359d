// SPDX-License-Identifier: Apache-2.0
// Files beside a render: none waits for a disk, none ends it.
#include "coordinator/run/file_writer.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <cerrno>
#include <fstream>
#include <future>

#include "common/base/files/atomic_file.h"
#include "coordinator/display/preview.h"
#include "coordinator/run/last_files.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    return names;
}

TEST(FileWriter, WritesOnlyTheNewestOfWhatWaits) {
    std::promise<void> begun, go_on;
    std::vector<int> written;
    std::promise<void> last;
    FileWriter writer;
    writer.put("a", [&] {
        begun.set_value();
        go_on.get_future().wait();
    });
    begun.get_future().wait();
    for (const int version : {1, 2, 3})
        writer.put("b", [&, version] {
            written.push_back(version);
            last.set_value();
        });
    go_on.set_value();
    last.get_future().wait();
    EXPECT_TRUE(writer.stop().empty());
    EXPECT_EQ(written, std::vector<int>{3});
}

TEST(FileWriter, TellsATroubleOnceAndTriesAgain) {
    std::atomic<int> tries = 0;
    std::promise<void> done;
    FileWriter writer;
    writer.put("a", [&] {
        if (++tries <= 2) throw FileError("a: full", ENOSPC);
        done.set_value();
    });
    done.get_future().wait();
    writer.stop();
    EXPECT_EQ(tries, 3);
    const std::vector<std::string> news = writer.take_news();
    ASSERT_EQ(news.size(), 2u) << "told once, and that it is over";
    EXPECT_EQ(news[0].find("a: full"), 0u);
    EXPECT_EQ(news[1], "all files are written again");
}

TEST(FileWriter, StopsWithoutWhatWaitsAndSaysWhatThatWas) {
    std::promise<void> begun;
    FileWriter writer;
    std::atomic<int> writes = 0;
    const auto write = [&] {
        if (++writes == 1) begun.set_value();
    };
    writer.put("slow", write, {1e6, 0});
    begun.get_future().wait();
    writer.put("slow", write, {1e6, 0});
    EXPECT_EQ(writer.stop(), std::vector<std::string>{"slow"});
    EXPECT_EQ(writes, 1) << "the second had to keep the pace";
}

TEST(LastFiles, AreWrittenEachOnItsOwn) {
    int failing = 0, late = 0;
    bool good = false;
    std::vector<LastFile> files = {{"bad", [&] { ++failing, throw RunError("bad: no space"); }},
                                   {"memory", [] { throw std::bad_alloc(); }},
                                   {"late",
                                    [&] {
                                        if (++late < 2) throw RunError("late");
                                    }},
                                   {"good", [&] { good = true; }}};
    const std::vector<std::string> failures = write_last_files(files, 0.3);
    EXPECT_TRUE(good);
    EXPECT_GE(failing, 2) << "tried again";
    EXPECT_EQ(late, 2) << "not again once it is written";
    ASSERT_EQ(failures.size(), 2u);
    EXPECT_EQ(failures[0], "bad: no space");
    EXPECT_EQ(failures[1].find("memory: not enough memory"), 0u);
}

TEST(AtomicFile, TemporariesCannotBeForeseenNorPlanted) {
    const fs::path folder = test::fresh_test_folder(), victim = folder / "victim";
    std::ofstream(victim) << "mine";
    // A name that nobody guesses: what stands in the way is what earlier programs used.
    fs::create_symlink(victim, folder / ("file.tmp" + std::to_string(getpid())));
    const std::vector<std::uint8_t> bytes{65};
    write_file_atomically(folder / "file", bytes);
    std::string text;
    std::ifstream(victim) >> text;
    EXPECT_EQ(text, "mine");
    EXPECT_FALSE(fs::is_symlink(folder / "file"));
}

TEST(AtomicFile, PermissionsFollowTheUmaskOrTheOldFile) {
    const fs::path folder = test::fresh_test_folder();
    const std::vector<std::uint8_t> bytes{65};
    const mode_t before = umask(027);
    write_file_atomically(folder / "new", bytes);
    umask(before);
    EXPECT_EQ(fs::status(folder / "new").permissions(), fs::perms{0640});
    fs::permissions(folder / "new", fs::perms{0604});
    write_file_atomically(folder / "new", bytes);
    EXPECT_EQ(fs::status(folder / "new").permissions(), fs::perms{0604});
    EXPECT_EQ(names_in(folder), std::vector<std::string>{"new"});
}

TEST(AtomicFile, TemporariesAreKnownByTheirNames) {
    EXPECT_TRUE(is_temporary_of("image.exr.tmp-abcdefghij01", "image.exr"));
    for (const char* other : {"image.exr", "image.exr.tmp-", "image.exr.tmp-short", "my.image.exr.tmp-abcdefghij01"})
        EXPECT_FALSE(is_temporary_of(other, "image.exr")) << other;
}

TEST(Preview, ShowsFinishedPassesAndWhatHasComeOfTheNext) {
    CombinedImage image;
    image.mean = {Rgb64(1.0), Rgb64(1.0)};
    std::vector<PixelEstimate> film(2);
    for (std::uint32_t sample = 0; sample < 3; ++sample)
        film[1].add(sample, Rgb(5.0f));
    const PassPixels pass = pass_pixels(film);
    const RgbImage both = preview_image(image, 1, pass, 2, 1);
    EXPECT_EQ(both.pixels[0], Rgb(1.0f)) << "of the pass in hand nothing has come";
    EXPECT_EQ(both.pixels[1], Rgb(4.0f)) << "one sample of 1, three of 5";
    const RgbImage first = preview_image({}, 0, pass, 2, 1);
    EXPECT_EQ(first.pixels[0], Rgb(0.0f));
    EXPECT_EQ(first.pixels[1], Rgb(5.0f));
}

}  // namespace
}  // namespace treefarm
