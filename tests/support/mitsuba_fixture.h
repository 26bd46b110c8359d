// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "coordinator/input/load.h"
#include "tests/support/refusal.h"
#include "tests/support/test_folder.h"

namespace treefarm::test {

/// Fixture that writes files below the test's temporary folder, and reads them.
class MitsubaFixture : public FolderTest {
  protected:
    void SetUp() override { std::filesystem::create_directories(folder_ / "sub"); }

    LoadedScene load(const std::string& body, const std::string& version = "0.6.0",
                     const std::map<std::string, std::string>& defines = {}, bool lenient = false) const {
        return load_scene(write("scene.xml", "<scene version=\"" + version + "\">\n" + body + "</scene>\n"), defines,
                          lenient);
    }

    /// Loads a scene with a default sensor, for tests of other elements.
    LoadedScene load_with_sensor(const std::string& body, const std::string& version = "0.6.0") const {
        return load("<sensor type=\"perspective\"/>\n" + body, version);
    }

    /// The message about such a scene that is refused; "" for one that is read.
    std::string refusal(const std::string& body, const std::string& version = "0.6.0") const {
        return refusal_of([&] { load_with_sensor(body, version); });
    }
};

inline void expect_near(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
    EXPECT_LT((a - b).length(), tolerance) << a << " and " << b;
}

inline Vec3 triangle_normal(const Mesh& mesh, std::size_t i) {
    const Vec3 a = mesh.positions[mesh.indices[3 * i]], b = mesh.positions[mesh.indices[3 * i + 1]],
               c = mesh.positions[mesh.indices[3 * i + 2]];
    return normalize(cross(b - a, c - a));
}

inline const Mesh& mesh_of(const LoadedScene& loaded, std::size_t shape = 0) {
    return std::get<Mesh>(loaded.scene.shapes.at(shape).geometry);
}

inline Vec3 direction(const Camera& camera, float x, float y) {
    return normalize(camera.corner + camera.across * x + camera.down * y);
}

inline std::string sensor(const std::string& inside, int width = 200, int height = 100) {
    return "<sensor type=\"perspective\">" + inside + "<film type=\"hdrfilm\"><integer name=\"width\" value=\"" +
           std::to_string(width) + "\"/><integer name=\"height\" value=\"" + std::to_string(height) +
           "\"/></film></sensor>\n";
}

}  // namespace treefarm::test
