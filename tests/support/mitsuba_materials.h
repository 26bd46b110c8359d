// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/support/mitsuba_fixture.h"

namespace treefarm::test {

class MitsubaMaterials : public MitsubaFixture {
  protected:
    Scene scene(const std::string& bsdf, const std::string& version = "0.6.0") const {
        return load_with_sensor("<shape type=\"rectangle\">" + bsdf + "</shape>", version).scene;
    }
    /// Material of a shape with this BSDF.
    Material material(const std::string& bsdf, const std::string& version = "0.6.0") const {
        const Scene s = scene(bsdf, version);
        return s.materials.at(static_cast<std::size_t>(s.shapes.at(0).material));
    }
    template <class T>
    T of_type(const std::string& type, const std::string& inside = "", const std::string& version = "0.6.0") const {
        return std::get<T>(material("<bsdf type=\"" + type + "\">" + inside + "</bsdf>", version).bsdf);
    }
};

inline std::string number(const std::string& name, const std::string& value) {
    return "<float name=\"" + name + "\" value=\"" + value + "\"/>";
}
inline std::string word(const std::string& name, const std::string& value) {
    return "<string name=\"" + name + "\" value=\"" + value + "\"/>";
}
inline std::string rgb(const std::string& name, const std::string& value) {
    return "<rgb name=\"" + name + "\" value=\"" + value + "\"/>";
}
inline std::string bsdf(const std::string& type, const std::string& inside = "") {
    return "<bsdf type=\"" + type + "\">" + inside + "</bsdf>";
}
inline std::string board(const std::string& name) {
    return "<texture type=\"checkerboard\" name=\"" + name + "\"/>";
}

}  // namespace treefarm::test
