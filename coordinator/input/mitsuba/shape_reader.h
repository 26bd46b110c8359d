// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/materials.h"
#include "coordinator/input/mitsuba/obj_materials.h"
#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Turns shape elements into shapes of the scene, with their materials and area emitters. Shapes of a shapegroup become
/// a group, for instances.
class ShapeReader {
  public:
    ShapeReader(Scene& scene, MaterialReader& materials, const SceneDocument& document, Diagnostics& diagnostics)
        : scene_(scene), materials_(materials), document_(document), diagnostics_(diagnostics) {}

    /// Reads a shape element. Instances within groups, emitters within groups and groups without shapes throw
    /// InputError, or are skipped when lenient.
    void read(const XmlElement& shape);

  private:
    /// A surface with one material.
    struct Part {
        decltype(Shape::geometry) geometry;
        ObjMaterial material;
    };
    /// Whether a part has no area; warns if so.
    bool is_flat(const Part& part, const XmlElement& element, bool on_emitter);
    void add(Part part, const Properties& properties, const XmlElement* emitter, std::int32_t group);
    void read_shape(const XmlElement& element, std::int32_t group);
    /// Reads shapes that Mitsuba 3 merges for speed; here they stay separate.
    void read_merged(const XmlElement& element, std::int32_t group);
    void read_instance(const XmlElement& element);
    /// Group of a <shape type="shapegroup">, read on first use; kNone if it is empty.
    std::int32_t group_of(const XmlElement& element);

    Scene& scene_;
    MaterialReader& materials_;
    const SceneDocument& document_;
    Diagnostics& diagnostics_;
    std::map<const XmlElement*, std::int32_t> groups_;
    std::uint64_t triangles_ = 0;  ///< triangles of the shapes read so far
};

}  // namespace treefarm::mitsuba
