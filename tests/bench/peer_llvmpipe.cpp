#include "peers.h"

#ifdef DELTAZ_HAVE_EGL

#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <cstdlib>

namespace deltaz::bench {
namespace {

constexpr const char* kVertexShader = R"(#version 330
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
layout(location = 2) in vec2 place;
uniform mat4 clip;
out vec4 lit;
out vec2 texel;
void main() { gl_Position = clip * vec4(position, 1); lit = color; texel = place; })";
constexpr const char* kGouraudShader =
    "#version 330\nin vec4 lit;\nout vec4 pixel;\nvoid main() { pixel = lit; }";
constexpr const char* kTextureShader =
    "#version 330\nin vec4 lit;\nin vec2 texel;\nuniform sampler2D map;\nout vec4 pixel;\n"
    "void main() { pixel = lit * texture(map, texel); }";

struct Interleaved {
  float x, y, z;
  std::uint32_t rgba;
  float u, v;
};

GLuint compiled(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  return shader;
}

class Llvmpipe : public Peer {
 public:
  static std::unique_ptr<Llvmpipe> make(const PeerScene& scene, PeerMode mode, int samples) {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    std::unique_ptr<Llvmpipe> peer(new Llvmpipe(scene, samples));
    return peer->start() && peer->upload(scene, mode) ? std::move(peer) : nullptr;
  }

  ~Llvmpipe() override {
    if (display_ == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
  }

  std::string name() const override { return name_; }

  void frame() override {
    current();
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDrawElements(GL_TRIANGLES, indices_, GL_UNSIGNED_INT, nullptr);
    if (samples_ > 1) {
      glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_);
      glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
      glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
    glFinish();
  }

  std::vector<std::uint32_t> picture() override {
    current();
    const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
    std::vector<std::uint32_t> upward(width * height), pixels(width * height);
    glBindFramebuffer(GL_FRAMEBUFFER, samples_ > 1 ? resolved_ : drawn_);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, upward.data());
    for (std::size_t i = 0; i < height; ++i)
      std::copy_n(upward.begin() + static_cast<std::ptrdiff_t>((height - 1 - i) * width), width,
                  pixels.begin() + static_cast<std::ptrdiff_t>(i * width));
    return pixels;
  }

 private:
  Llvmpipe(const PeerScene& scene, int samples)
      : width_(scene.width), height_(scene.height), samples_(samples) {}

  void current() { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_); }

  bool start() {
    const auto platform_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (platform_display == nullptr) return false;
    display_ = platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    EGLint major = 0, minor = 0, configs = 0;
    if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, &major, &minor) == EGL_FALSE) return false;
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                             EGL_NONE};
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
    EGLConfig config = nullptr;
    eglChooseConfig(display_, wanted, &config, 1, &configs);
    eglBindAPI(EGL_OPENGL_API);
    context_ = eglCreateContext(display_, configs > 0 ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    if (context_ == EGL_NO_CONTEXT) return false;
    current();
    name_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return name_.find("llvmpipe") != std::string::npos;
  }

  bool makeTarget(GLuint& target, int samples, bool with_depth) {
    GLuint color = 0, depth = 0;
    glGenFramebuffers(1, &target);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glGenRenderbuffers(1, &color);
    glBindRenderbuffer(GL_RENDERBUFFER, color);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, GL_RGBA8, width_, height_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
    if (with_depth) {
      glGenRenderbuffers(1, &depth);
      glBindRenderbuffer(GL_RENDERBUFFER, depth);
      glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, GL_DEPTH_COMPONENT32F,
                                       width_, height_);
      glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    }
    return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  }

  bool upload(const PeerScene& scene, PeerMode mode) {
    if (samples_ > 1 && !makeTarget(resolved_, 1, false)) return false;
    if (!makeTarget(drawn_, samples_, true)) return false;
    glViewport(0, 0, width_, height_);
    std::vector<Interleaved> vertices(scene.vertices.x.size());
    for (std::size_t n = 0; n < vertices.size(); ++n)
      vertices[n] = {scene.vertices.x[n],    scene.vertices.y[n], scene.vertices.z[n],
                     scene.vertices.rgba[n], scene.texture_u[n],  scene.texture_v[n]};
    GLuint array = 0, buffers[2] = {};
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(2, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Interleaved)),
                 vertices.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(scene.triangles.size() * 12),
                 scene.triangles.data(), GL_STATIC_DRAW);
    indices_ = static_cast<GLsizei>(scene.triangles.size() * 3);
    const auto offset = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Interleaved), offset(0));
    glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Interleaved), offset(12));
    glVertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, sizeof(Interleaved), offset(16));
    for (GLuint attribute = 0; attribute < 3; ++attribute) glEnableVertexAttribArray(attribute);

    const GLuint program = glCreateProgram();
    glAttachShader(program, compiled(GL_VERTEX_SHADER, kVertexShader));
    glAttachShader(
        program, compiled(GL_FRAGMENT_SHADER, mode == PeerMode::kTextured ? kTextureShader : kGouraudShader));
    glLinkProgram(program);
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "clip"), 1, GL_FALSE, scene.clipMatrix().data());
    if (mode == PeerMode::kTextured) {
      const std::vector<std::uint32_t> texels = peerTexture();
      GLuint texture = 0;
      glGenTextures(1, &texture);
      glBindTexture(GL_TEXTURE_2D, texture);
      glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, kPeerTextureSide, kPeerTextureSide, 0, GL_RGBA,
                   GL_UNSIGNED_BYTE, texels.data());
      glGenerateMipmap(GL_TEXTURE_2D);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    }
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glClearColor(0.45F, 0.6F, 0.85F, 1);
    if (samples_ > 1) glEnable(GL_MULTISAMPLE);
    return glGetError() == GL_NO_ERROR;
  }

  int width_, height_, samples_;
  GLsizei indices_ = 0;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  GLuint drawn_ = 0, resolved_ = 0;
  std::string name_;
};

}  // namespace

std::unique_ptr<Peer> makeLlvmpipe(const PeerScene& scene, PeerMode mode, int samples) {
  return Llvmpipe::make(scene, mode, samples);
}

}  // namespace deltaz::bench

#else

namespace deltaz::bench {

std::unique_ptr<Peer> makeLlvmpipe(const PeerScene&, PeerMode, int) {
  return nullptr;
}

}  // namespace deltaz::bench

#endif
