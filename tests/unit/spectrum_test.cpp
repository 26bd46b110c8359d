// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coordinator/input/colour/cie_1931.h"
#include "coordinator/input/colour/spectra.h"
#include "coordinator/input/mitsuba/colors.h"

namespace treefarm::mitsuba {
namespace {

XmlElement element_of(const std::string& tag, const std::string& value, int version = 0) {
    XmlElement element;
    element.tag = tag;
    element.attributes = {{"name", "reflectance"}, {"value", value}};
    element.where = {"s.xml", 3, 4};
    element.version = version;
    return element;
}

Rgb color_of(const std::string& tag, const std::string& value, ColorUse use = ColorUse::reflectance, int version = 0) {
    Diagnostics diagnostics(false);
    return read_color(element_of(tag, value, version), use, diagnostics);
}

void expect_near(const Rgb& a, const Rgb& b, float tolerance) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(a[i], b[i], tolerance) << "channel " << i;
}

TEST(Cie, SumsAndPeaks) {
    const CieTables& cie = cie_tables();
    double x = 0, y = 0, z = 0;
    for (std::size_t i = 0; i < CieTables::kCount; ++i) {
        x += cie.x[i];
        y += cie.y[i];
        z += cie.z[i];
    }
    // The sums of tables at 1 nm: equal, for equal energy is white in XYZ.
    EXPECT_NEAR(x, 106.865, 0.02);
    EXPECT_NEAR(y, 106.857, 0.02);
    EXPECT_NEAR(z, 106.892, 0.02);
    EXPECT_NEAR(cie.y[555 - 360], 1.0, 1e-6);
    EXPECT_NEAR(cie.d65[560 - 360], 100.0, 1e-4);
}

TEST(Spectrum, EqualEnergyIsWhatTheEyeSees) {
    const auto rgb = spectrum_to_rgb({{100.0, 1.0}, {1000.0, 1.0}}, false);
    EXPECT_NEAR(rgb.x, 1.204886, 1e-4);
    EXPECT_NEAR(rgb.y, 0.948228, 1e-4);
    EXPECT_NEAR(rgb.z, 0.909266, 1e-4);
    EXPECT_NEAR(0.212671 * rgb.x + 0.715160 * rgb.y + 0.072169 * rgb.z, 1.0, 1e-5);
}

TEST(Spectrum, WhiteUnderD65IsWhite) {
    const auto rgb = spectrum_to_rgb({{300.0, 0.5}, {900.0, 0.5}}, true);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(rgb[i], 0.5, 1e-3);
}

TEST(Spectrum, ZeroOutsideItsRange) {
    // Two halves of a spectrum that meet add up to the whole.
    const SpectrumSamples whole = {{400.0, 1.0}, {700.0, 1.0}}, low = {{400.0, 1.0}, {550.5, 1.0}},
                          high = {{550.5, 1.0}, {700.0, 1.0}};
    const auto sum = spectrum_to_rgb(low, false) + spectrum_to_rgb(high, false), all = spectrum_to_rgb(whole, false);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(sum[i], all[i], 1e-12);
    EXPECT_EQ(spectrum_to_rgb({{1000.0, 5.0}, {1100.0, 5.0}}, false), Imath::Color3<double>(0.0));
}

TEST(Spectrum, IsLinear) {
    const auto one = spectrum_to_rgb({{412.3, 0.1}, {555.0, 0.7}, {601.7, 0.2}}, false);
    const auto three = spectrum_to_rgb({{412.3, 0.3}, {555.0, 2.1}, {601.7, 0.6}}, false);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(three[i], 3.0 * one[i], 1e-12);
}

TEST(Spectrum, ListsFallToZeroInVersion0) {
    // One step of mean spacing at either end, as Mitsuba 0.6 has it: 300:0 and 800:0 are added.
    const Rgb list = color_of("spectrum", "400:0, 500:16, 600:31.2, 700:36.8", ColorUse::radiance);
    const auto extended = spectrum_to_rgb({{400, 0}, {500, 16}, {600, 31.2}, {700, 36.8}, {800, 0}}, false);
    expect_near(list, Rgb(Imath::Color3<float>(Imath::V3f(Imath::V3d(extended.x, extended.y, extended.z)))), 1e-5f);
    const Rgb cut = color_of("spectrum", "400:0, 500:16, 600:31.2, 700:36.8", ColorUse::radiance, 2);
    EXPECT_LT(cut.x, list.x);
}

TEST(Spectrum, RunsBackwardsBetweenSamplesInVersion05) {
    XmlElement element = element_of("spectrum", "400:0, 500:16, 600:31.2, 700:36.8", 0);
    element.is_0_5 = true;
    Diagnostics diagnostics(false);
    // The light of the published Cornell box: what its published renders show, within their noise.
    expect_near(read_color(element, ColorUse::radiance, diagnostics), Rgb(36.8f, 22.0f, 5.515f), 0.1f);
}

TEST(Spectrum, ColoursOfElements) {
    expect_near(color_of("rgb", "0.1, 0.2 0.3"), Rgb(0.1f, 0.2f, 0.3f), 1e-7f);
    expect_near(color_of("rgb", "0.25"), Rgb(0.25f), 1e-7f);
    expect_near(color_of("rgb", "#ff0080"), Rgb(1.0f, 0.0f, 128.0f / 255.0f), 1e-7f);
    expect_near(color_of("srgb", "#FF8000"), Rgb(1.0f, 0.21586f, 0.0f), 1e-5f);
    expect_near(color_of("srgb", "0.5, 0.04, 0"), Rgb(0.214041f, 0.0030960f, 0.0f), 1e-6f);
    expect_near(color_of("spectrum", "0.5"), Rgb(0.5f), 1e-7f);
    expect_near(color_of("spectrum", "2", ColorUse::radiance), Rgb(2.0f), 1e-7f);
    expect_near(color_of("spectrum", "1", ColorUse::radiance, 3), Rgb(1.204794f, 0.948291f, 0.908916f), 1e-4f);
}

TEST(Spectrum, ReflectanceStaysBelowOne) {
    Diagnostics diagnostics(false);
    const Rgb rgb = read_color(element_of("spectrum", "300:1, 900:1"), ColorUse::reflectance, diagnostics);
    EXPECT_EQ(rgb.x, 0.99f);
    EXPECT_LT(rgb.z, 0.8f);
    EXPECT_EQ(diagnostics.warnings().size(), 1u);
}

TEST(Spectrum, BadValuesAreRefused) {
    for (const char* value : {"", "400:1", "400:1, 300:1", "400:1, 400:1", "400:1, 500", "400:x, 500:1", "nan",
                              "1 2 3 4", "400:1:2, 500:1"})
        EXPECT_THROW(color_of("spectrum", value), InputError) << value;
    for (const char* value : {"", "1 1", "-0.1", "0.1, 0.2, nan", "#12345", "#12345g", "a"})
        EXPECT_THROW(color_of("rgb", value), InputError) << value;
    for (const char* value : {"1.5", "1e39"})  // 0.6 scales it
        EXPECT_THROW(color_of("rgb", value, ColorUse::reflectance, 3), InputError) << value;
    EXPECT_THROW(color_of("rgb", "-1", ColorUse::radiance), InputError);
    EXPECT_THROW(color_of("rgb", "1e39", ColorUse::radiance), InputError);
}

}  // namespace
}  // namespace treefarm::mitsuba
