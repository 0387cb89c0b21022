// One OpenGL object, owned. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace elbowroom::recon::gl {

// Kind: struct with static GLuint Create() and static void Destroy(GLuint). Move-only.
// Thread: that of its context, which must be current when it is made and destroyed.
template <typename Kind>
class GlName {
 public:
  GlName() : name_(Kind::Create()) {}
  ~GlName() {
    if (name_ != 0) Kind::Destroy(name_);
  }
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }

  [[nodiscard]] GLuint get() const { return name_; }

 private:
  GLuint name_;
};

}  // namespace elbowroom::recon::gl
