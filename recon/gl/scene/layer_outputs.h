// What the shaders of still things write.
#pragma once

namespace elbowroom::recon::gl {

// Fragment shader source. A target that is no StillLayer takes `pixel` alone.
inline constexpr const char* kLayerOutputs = R"(
layout(location = 0) out vec4 pixel;
layout(location = 1) out vec4 unlit;  // the same without any light of the lamp
// The surface's normal times its depth, in camera axes; w is 1 where that replaces what is there, else 0.
layout(location = 2) out vec4 place;
)";

}  // namespace elbowroom::recon::gl
