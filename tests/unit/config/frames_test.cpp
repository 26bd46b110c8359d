// SPDX-License-Identifier: Apache-2.0
#include "coordinator/shot/frames.h"

#include <gtest/gtest.h>

#include "tests/support/refusal.h"

namespace treefarm {
namespace {

std::vector<int> frames(std::string_view text) {
    return parse_frames(text, Location{"--frames", 0, 0});
}

std::string complaint(std::string_view text) {
    return test::refusal_of([&] { frames(text); }, "accepted");
}

using Numbers = std::vector<int>;

TEST(Frames, RangesStepsAndLists) {
    EXPECT_EQ(frames("7"), Numbers{7});
    EXPECT_EQ(frames("0-3"), (Numbers{0, 1, 2, 3}));
    EXPECT_EQ(frames("1-8x3"), (Numbers{1, 4, 7}));
    EXPECT_EQ(frames("1-7x3"), (Numbers{1, 4, 7})) << "the end is a frame where a step meets it";
    EXPECT_EQ(frames("1,5,9-12"), (Numbers{1, 5, 9, 10, 11, 12}));
    EXPECT_EQ(frames(" 3 - 4 , 0010 "), (Numbers{3, 4, 10}));
    EXPECT_EQ(frames("5,1-3,2-6"), (Numbers{5, 1, 2, 3, 4, 6})) << "in the order of the text, each once";
    EXPECT_EQ(frames("9999999"), Numbers{kLastFrame});
    EXPECT_EQ(frames("1-100000").size(), static_cast<std::size_t>(kMostFrames));
    EXPECT_EQ(frames("0-9999999x9999999"), (Numbers{0, kLastFrame}));
}

TEST(Frames, WhatIsNoRangeIsRefusedWithACure) {
    const struct {
        const char *text, *what, *cure;
    } refused[] = {
        {"", "there are no frames", "1-24x2"},
        {"  ", "there are no frames", "1-24x2"},
        {"1,,2", "missing between commas", "1,5,9-12"},
        {"1,2,", "missing between commas", "1,5,9-12"},
        {"a", "\"a\" in \"a\" is no frame number", "whole numbers"},
        {"-3", "is no frame number, but negative", "from 0 on"},
        {"1,-2-2", "\"-2-2\" is no frame number, but negative", "from 0 on"},
        {"1-", "\"\" in \"1-\" is no frame number", "1-24"},
        {"1--3", "is no frame number", "from 0 on"},
        {"1.5", "is no frame number", "whole numbers"},
        {"+4", "is no frame number", "whole numbers"},
        {"1-2-3", "is no frame number", "1-24"},
        {"24-1", "ends before it begins", "write 1-24"},
        {"1-9x0", "a step of 0", "1-24x2"},
        {"1-9x", "is no frame number", "1-24x2"},
        {"1-9x-2", "is no frame number", "1-24x2"},
        {"3x2", "a step without a range", "1-24x2"},
        {"3x2-4", "a step without a range", "1-24x2"},
        {"10000000", "is above 9999999", "from 0 on"},
        {"99999999999999999999", "is above 9999999", "from 0 on"},
        {"0-100000", "more than 100000 frames", "several shots"},
    };
    for (const auto& [text, what, cure] : refused) {
        const std::string message = complaint(text);
        EXPECT_EQ(message.substr(0, 10), "--frames: ") << text;
        EXPECT_NE(message.find(what), std::string::npos) << text << ": " << message;
        EXPECT_NE(message.find(cure), std::string::npos) << text << ": " << message;
    }
}

TEST(Frames, NumbersStandForTheirMarks) {
    EXPECT_EQ(for_frame("frame=%d", 7), "frame=7");
    EXPECT_EQ(for_frame("a%04d_%d_%02d.xml", 123), "a0123_123_123.xml");
    EXPECT_EQ(for_frame("%d%d", 5), "55");
    for (const char* plain : {"", "5%", "100%x", "%4d", "%0d", "%004d", "%00d", "% d", "%D", "#", "%09", "%"}) {
        EXPECT_EQ(for_frame(plain, 7), plain);
        EXPECT_FALSE(names_frame(plain)) << plain;
    }
    EXPECT_EQ(for_frame("%%d", 7), "%7");
    EXPECT_TRUE(names_frame("5% of %03d"));
    EXPECT_EQ(output_for_frame("s/f.####.exr", 7), "s/f.0007.exr");
    EXPECT_EQ(output_for_frame("#_##_%03d.png", 123), "123_123_123.png");
    EXPECT_EQ(output_for_frame("shot#2/f.####.exr", 7), "shot#2/f.0007.exr") << "folders keep their names";
    EXPECT_EQ(output_for_frame("shot#2/%02d/f.exr", 7), "shot#2/07/f.exr");
    EXPECT_FALSE(output_names_frame("shot#2/f.exr"));
    EXPECT_TRUE(output_names_frame("f#.exr"));
    EXPECT_TRUE(output_names_frame("f%d.exr"));
    EXPECT_FALSE(output_names_frame("f%.exr"));
    EXPECT_EQ(frame_digits(12345), "12345");
    EXPECT_EQ(frame_digits(0), "0000");
}

TEST(Frames, NamesWithoutTheirMarks) {
    EXPECT_EQ(name_without_frame("walk.%04d"), "walk");
    EXPECT_EQ(name_without_frame("walk_%d"), "walk");
    EXPECT_EQ(name_without_frame("%d-walk"), "-walk");
    EXPECT_EQ(name_without_frame("walk"), "walk");
}

}  // namespace
}  // namespace treefarm
