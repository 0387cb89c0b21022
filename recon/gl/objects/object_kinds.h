// The kinds of object that GlName owns in several files. For the .cc files of this folder: it includes
// OpenGL.
#pragma once

#include "recon/gl/objects/gl_name.h"

namespace elbowroom::recon::gl {

struct BufferKind {
  static GLuint Create() {
    GLuint name = 0;
    glGenBuffers(1, &name);
    return name;
  }
  static void Destroy(GLuint name) { glDeleteBuffers(1, &name); }
};

struct FramebufferKind {
  static GLuint Create() {
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    return name;
  }
  static void Destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};

struct RenderbufferKind {
  static GLuint Create() {
    GLuint name = 0;
    glGenRenderbuffers(1, &name);
    return name;
  }
  static void Destroy(GLuint name) { glDeleteRenderbuffers(1, &name); }
};

struct TextureKind {
  static GLuint Create() {
    GLuint name = 0;
    glGenTextures(1, &name);
    return name;
  }
  static void Destroy(GLuint name) { glDeleteTextures(1, &name); }
};

}  // namespace elbowroom::recon::gl
