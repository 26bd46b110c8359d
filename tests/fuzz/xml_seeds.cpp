// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/xml_seeds.h"

namespace treefarm::fuzz {
namespace {

constexpr char kOldDocument[] = R"(<?xml version="1.0"?>
<!-- comment -->
<scene version="0.5.0">
<default name="w" value="8"/><include filename="part.xml"/>
<integrator type="path"><integer name="maxDepth" value="6"/><boolean name="strictNormals" value="true"/></integrator>
<sensor type="thinlens"><float name="fov" value="40"/><string name="fovAxis" value="smaller"/>
<float name="apertureRadius" value="0.1"/><float name="focusDistance" value="3"/>
<transform name="toWorld"><scale x="-1"/><lookAt origin="0,0,4" target="0,0,0" up="0,1,0"/></transform>
<sampler type="independent"><integer name="sampleCount" value="16"/></sampler>
<film type="hdrfilm"><integer name="width" value="$w"/><integer name="height" value="6"/>
<rfilter type="gaussian"><float name="stddev" value="0.5"/></rfilter></film></sensor>
<shape type="cube"><ref id="included"/><transform name="toWorld"><rotate y="1" angle="30"/><translate z="-1"/>
<matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/></transform></shape>
<shape type="rectangle"><emitter type="area"><rgb name="radiance" value="1, 2, 3"/></emitter></shape>
</scene>
)";

constexpr char kOldMaterials[] = R"(<scene version="0.6.0">
<sensor type="perspective"><string name="focalLength" value="50mm"/></sensor>
<texture type="bitmap" id="t"><string name="filename" value="t.png"/><float name="uscale" value="2"/></texture>
<bsdf type="twosided" id="a"><bsdf type="roughconductor"><string name="material" value="Al"/>
<string name="distribution" value="ggx"/><float name="alphaU" value="0.1"/><float name="alphaV" value="0.3"/></bsdf>
<bsdf type="diffuse"><ref id="t" name="reflectance"/></bsdf></bsdf>
<bsdf type="mask" id="b"><texture type="bitmap" name="opacity"><string name="filename" value="t.png"/>
<string name="channel" value="g"/><string name="wrapMode" value="clamp"/></texture>
<bsdf type="bumpmap"><texture type="scale"><float name="scale" value="0.1"/><texture type="bitmap">
<string name="filename" value="t.png"/><float name="gamma" value="1"/></texture></texture>
<bsdf type="roughplastic"><float name="alpha" value="0.2"/><boolean name="nonlinear" value="true"/></bsdf></bsdf></bsdf>
<bsdf type="blendbsdf" id="c"><float name="weight" value="0.3"/><bsdf type="plastic"/><bsdf type="conductor">
<spectrum name="eta" value="400:1.2, 500:1.1, 700:0.9"/><spectrum name="k" value="3"/></bsdf></bsdf>
<bsdf type="mixturebsdf" id="d"><string name="weights" value="0.5, 0.3"/><bsdf type="diffuse"/>
<bsdf type="roughdielectric"><float name="intIOR" value="1.5"/><string name="extIOR" value="air"/></bsdf></bsdf>
<bsdf type="normalmap" id="e"><texture type="bitmap"><string name="filename" value="t.png"/>
<float name="gamma" value="1"/></texture><bsdf type="diffuse"><srgb name="reflectance" value="#808040"/></bsdf></bsdf>
<shape type="sphere"><ref id="a"/></shape><shape type="sphere"><ref id="b"/></shape>
<shape type="disk"><ref id="c"/></shape><shape type="disk"><ref id="d"/></shape>
<shape type="rectangle"><ref id="e"/></shape>
<shape type="cylinder"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
<spectrum name="color0" filename="s.spd"/><float name="uoffset" value="0.5"/></texture></bsdf></shape>
<emitter type="constant"><blackbody name="radiance" temperature="5000" scale="1e-3"/></emitter>
</scene>
)";

constexpr char kOldShapes[] = R"(<scene version="0.6.0"><sensor type="perspective"/>
<shape type="obj"><string name="filename" value="m.obj"/><boolean name="faceNormals" value="true"/></shape>
<shape type="ply"><string name="filename" value="m.ply"/><float name="maxSmoothAngle" value="40"/></shape>
<shape type="serialized"><string name="filename" value="m.serialized"/><integer name="shapeIndex" value="0"/>
<boolean name="flipNormals" value="true"/></shape>
<shape type="shapegroup" id="g"><shape type="sphere"><point name="center" x="1" y="2" z="3"/>
<float name="radius" value="0.5"/></shape><shape type="obj"><string name="filename" value="m.obj"/></shape></shape>
<shape type="instance"><ref id="g"/><transform name="toWorld"><translate x="3"/></transform></shape>
<shape type="instance"><ref id="g"/><transform name="toWorld"><scale value="2"/></transform></shape>
<shape type="cylinder"><point name="p0" x="0" y="0" z="0"/><point name="p1" x="0" y="1" z="0"/>
<float name="radius" value="0.2"/><bsdf type="null"/></shape>
<shape type="disk"><emitter type="area"><texture type="bitmap" name="radiance">
<string name="filename" value="e.exr"/></texture></emitter></shape>
<emitter type="point"><point name="position" x="1" y="2" z="1"/><spectrum name="intensity" value="4"/></emitter>
<emitter type="spot"><float name="cutoffAngle" value="20"/><transform name="toWorld">
<lookat origin="0 1 0" target="0 0 0" up="1 0 0"/></transform></emitter>
<emitter type="directional"><vector name="direction" x="0" y="-1" z="0.1"/></emitter>
<emitter type="envmap"><string name="filename" value="e.hdr"/><float name="scale" value="2"/></emitter>
</scene>
)";

constexpr char kOldSky[] = R"(<scene version="0.6.0"><sensor type="perspective"/><emitter type="sunsky">
<integer name="resolution" value="8"/><float name="turbidity" value="3"/><float name="latitude" value="50"/>
<float name="hour" value="12"/><integer name="month" value="6"/><boolean name="extend" value="true"/>
<float name="sunRadiusScale" value="20"/><float name="skyScale" value="2"/></emitter>
<shape type="cube"/></scene>
)";

constexpr char kNewDocument[] = R"(<scene version="3.0.0">
<default name="spp" value="4"/><default name="name" value="t"/>
<integrator type="path"><integer name="max_depth" value="-1"/><boolean name="hide_emitters" value="false"/></integrator>
<sensor type="perspective"><float name="fov" value="45"/><string name="fov_axis" value="x"/>
<float name="principal_point_offset_x" value="0.1"/><transform name="to_world"><lookat origin="0, 1, 5"
target="0, 0, 0" up="0, 1, 0"/></transform><sampler type="multijitter"><integer name="sample_count" value="$spp"/>
<integer name="seed" value="3"/></sampler><film type="hdrfilm"><integer name="width" value="16"/>
<integer name="height" value="9"/><string name="pixel_format" value="rgb"/><rfilter type="tent"/></film></sensor>
<bsdf type="dielectric" id="glass"><float name="int_ior" value="1.5"/><rgb name="specular_transmittance" value="0.9"/>
</bsdf><bsdf type="thindielectric" id="pane"/><alias id="glass" as="more glass"/>
<bsdf type="roughconductor" id="metal"><texture name="alpha" type="bitmap"><string name="filename" value="$name.png"/>
<boolean name="raw" value="true"/><transform name="to_uv"><scale x="3" y="2"/></transform></texture>
<rgb name="eta" value="0.2, 0.9, 1.1"/><rgb name="k" value="3.9 2.4 2.1"/></bsdf>
<bsdf type="bumpmap" id="bump"><texture type="bitmap"><string name="filename" value="t.png"/>
<boolean name="raw" value="true"/></texture><float name="scale" value="0.2"/><bsdf type="diffuse"/></bsdf>
<shape type="sphere"><ref id="more glass"/></shape><shape type="cube"><ref id="pane"/></shape>
<shape type="rectangle"><ref id="metal"/><transform name="to_world"><rotate value="1, 0, 0" angle="-90"/></transform>
</shape><shape type="disk"><ref id="bump"/></shape>
<emitter type="envmap"><string name="filename" value="e.exr"/><float name="scale" value="0.5"/></emitter>
<emitter type="point"><rgb name="intensity" value="1, 2, 3"/><point name="position" value="0, 3, 0"/></emitter>
</scene>
)";

/// A scene of things that are refused unless lenient.
constexpr char kUnknown[] = R"(<scene version="2.1.0"><sensor type="perspective"><film type="ldrfilm"/></sensor>
<medium type="homogeneous" id="m"/><bsdf type="hair" id="h"/>
<shape type="cube"><ref name="interior" id="m"/><ref id="h"/></shape>
<shape type="sphere"><bsdf type="twosided"><bsdf type="dielectric"/></bsdf><animation name="to_world">
<transform time="0"/></animation></shape><texture type="marble" id="x"/>
<bsdf type="diffuse" id="y"><ref id="x" name="reflectance"/></bsdf><shape type="disk"><ref id="y"/></shape>
<emitter type="sun"><float name="sun_scale" value="1"/><vector name="sun_direction" value="0 0.1 1"/></emitter></scene>
)";

}  // namespace

std::vector<std::string> xml_seeds() {
    return {kOldDocument, kOldMaterials, kOldShapes, kOldSky, kNewDocument, kUnknown};
}

}  // namespace treefarm::fuzz
