// SPDX-License-Identifier: Apache-2.0
#include "report/html.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace treefarm {

namespace {

std::array<std::uint8_t, 4> rgbe(const Rgb& colour) {
    double c[3];
    for (int k = 0; k < 3; ++k)
        c[k] = std::isfinite(colour[k]) ? std::max(0.0, static_cast<double>(colour[k])) : 0.0;
    int exponent = 0;
    const double largest = std::max({c[0], c[1], c[2]});
    if (!(largest > 1e-30) || largest > 1e30) return {};
    std::frexp(largest, &exponent);
    const auto byte = [&](double v) { return static_cast<std::uint8_t>(std::min(255.0, std::ldexp(v, 8 - exponent))); };
    return {byte(c[0]), byte(c[1]), byte(c[2]), static_cast<std::uint8_t>(exponent + 128)};
}

}  // namespace

std::string html_text(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        if (c == '<')
            safe += "&lt;";
        else if (c == '>')
            safe += "&gt;";
        else if (c == '&')
            safe += "&amp;";
        else if (c == '"')
            safe += "&quot;";
        else
            safe += c;
    }
    return safe;
}

std::string html_table(const std::vector<std::vector<std::string>>& rows) {
    std::string html = "<div class=\"wide\"><table>\n";
    for (std::size_t r = 0; r < rows.size(); ++r) {
        html += "<tr>";
        for (const std::string& cell : rows[r])
            html += (r == 0 ? "<th>" + cell + "</th>" : "<td>" + cell + "</td>");
        html += "</tr>\n";
    }
    return html + "</table></div>\n";
}

std::string base64(std::vector<std::uint8_t> bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t missing = (3 - bytes.size() % 3) % 3;
    bytes.resize(bytes.size() + missing);
    std::string text;
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        const auto word = static_cast<unsigned>(bytes[k] << 16 | bytes[k + 1] << 8 | bytes[k + 2]);
        for (int shift = 18; shift >= 0; shift -= 6)
            text += digits[word >> shift & 63];
    }
    std::fill(text.end() - static_cast<std::ptrdiff_t>(missing), text.end(), '=');
    return text;
}

std::string base64_rgbe(const RgbImage& image) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(4 * image.pixels.size() + 2);
    for (const Rgb& pixel : image.pixels)
        for (const std::uint8_t byte : rgbe(pixel))
            bytes.push_back(byte);
    return base64(std::move(bytes));
}

RgbImage reduced(const RgbImage& image, int longest) {
    const int side = (std::max(image.width, image.height) + longest - 1) / longest;
    if (side <= 1) return image;
    RgbImage small(image.width / side, image.height / side);
    const auto index = [](int x, int y, int width) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    };
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) {
            Rgb sum(0.0f);
            for (int k = 0; k < side * side; ++k)
                sum += image.pixels[index(x * side + k % side, y * side + k / side, image.width)];
            small.pixels[index(x, y, small.width)] = sum / static_cast<float>(side * side);
        }
    return small;
}

}  // namespace treefarm
