/// The program whose frames are captured in spinning_cube.gfxr and trail.gfxr: OpenGL 2.1 with GLX, 96x72
/// pixels.
///
/// It has what a small real program has: a lit and textured cube with a depth test and mip levels, drawn with
/// indices, and a blended rectangle that a scissor cuts. With "trail" each frame is drawn on top of the one
/// before it, its colours and its depths, in a framebuffer of the program's own. The build does not need it.
/// To capture anew, with libgl-dev and libx11-dev installed:
///   g++ -O1 -o /tmp/spinning_cube tests/traces/capture/own/spinning_cube.cpp -lGL -lX11
///   scripts/capture --frame 3 --out tests/traces/capture/own/spinning_cube /tmp/spinning_cube
///   scripts/capture --frame 1 --frames 3 --out tests/traces/capture/own/trail /tmp/spinning_cube trail
/// Of the latter's pictures the first is not kept: gfxreconstruct's replay shows nothing yet in a program's
/// first frame.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/glx.h>
#include <X11/Xlib.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

namespace {

constexpr int kWidth = 96, kHeight = 72;

constexpr const char* kVertex =
    "#version 120\n"
    "attribute vec3 position; attribute vec3 normal; attribute vec2 place;\n"
    "uniform mat4 matrix; uniform vec3 light;\n"
    "varying vec2 uv; varying float shade;\n"
    "void main() { gl_Position = matrix * vec4(position, 1.0); uv = place;\n"
    "  shade = 0.25 + 0.75 * max(dot(normal, light), 0.0); }\n";
constexpr const char* kFragment =
    "#version 120\n"
    "uniform sampler2D picture; uniform vec4 tint;\n"
    "varying vec2 uv; varying float shade;\n"
    "void main() { gl_FragColor = vec4(texture2D(picture, uv).rgb * shade, 1.0) * tint; }\n";

struct Corner {
  std::array<float, 3> position, normal;
  std::array<float, 2> place;
};

/// Four corners of each of six faces, and of a rectangle in front.
std::vector<Corner> corners() {
  std::vector<Corner> all;
  for (std::size_t face = 0; face < 6; ++face) {
    const std::size_t axis = face / 2;
    const float side = face % 2 == 0 ? 1.0f : -1.0f;
    for (int corner = 0; corner < 4; ++corner) {
      Corner c{};
      const float u = corner % 2 == 0 ? -1.0f : 1.0f, v = corner / 2 == 0 ? -1.0f : 1.0f;
      c.position.at(axis) = side;
      c.position.at((axis + 1) % 3) = u * side;
      c.position.at((axis + 2) % 3) = v;
      c.normal.at(axis) = side;
      c.place = {u + 1, v + 1};
      all.push_back(c);
    }
  }
  for (int corner = 0; corner < 4; ++corner) {
    const float u = corner % 2 == 0 ? -0.9f : 0.5f, v = corner / 2 == 0 ? -0.8f : -0.1f;
    all.push_back({{u, v, -0.5f}, {0, 0, 1}, {0, 0}});
  }
  return all;
}

GLuint shader(GLenum stage, const char* text) {
  const GLuint made = glCreateShader(stage);
  glShaderSource(made, 1, &text, nullptr);
  glCompileShader(made);
  return made;
}

GLuint program() {
  const GLuint made = glCreateProgram();
  glAttachShader(made, shader(GL_VERTEX_SHADER, kVertex));
  glAttachShader(made, shader(GL_FRAGMENT_SHADER, kFragment));
  glBindAttribLocation(made, 0, "position");
  glBindAttribLocation(made, 1, "normal");
  glBindAttribLocation(made, 2, "place");
  glLinkProgram(made);
  glUseProgram(made);
  return made;
}

/// Checkers, each level by itself: the finer ones in steps of light, so that levels can be told apart.
void upload_texture() {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  for (int level = 0, side = 16; side > 0; ++level, side /= 2) {
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < side * side; ++i) {
      const bool light = (4 * (i % side) / side + 4 * (i / side) / side) % 2 == 0;
      const int red = light ? 180 : 110, green = light ? 160 : 90 + 30 * (i % side) / side,
                blue = light ? 90 : 70 + 60 * (i / side) / side;
      for (const int byte : {red, green - 8 * level, blue, 255})
        texels.push_back(static_cast<std::uint8_t>(byte < 0 ? 0 : byte));
    }
    glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA8, side, side, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
  }
}

void upload() {
  const std::vector<Corner> vertices = corners();
  std::vector<std::uint16_t> indices;
  for (std::uint16_t face = 0; face < 7; ++face)
    for (const std::uint16_t corner : {0, 1, 2, 2, 1, 3})
      indices.push_back(static_cast<std::uint16_t>(4 * face + corner));
  std::array<GLuint, 2> buffers{};
  glGenBuffers(2, buffers.data());
  glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Corner)), vertices.data(),
               GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(2 * indices.size()), indices.data(),
               GL_STATIC_DRAW);
  const std::array<std::size_t, 3> offsets{offsetof(Corner, position), offsetof(Corner, normal),
                                           offsetof(Corner, place)};
  for (GLuint i = 0; i < 3; ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, i == 2 ? 2 : 3, GL_FLOAT, GL_FALSE, sizeof(Corner),
                          reinterpret_cast<const void*>(offsets.at(i)));
  }
  upload_texture();
}

/// A cube turned about two axes and seen in perspective; columns.
std::array<float, 16> cube_matrix(float angle) {
  const float c = std::cos(angle), s = std::sin(angle), near = 1.0f, far = 10.0f, away = -5.0f;
  const float depth = (far + near) / (near - far), shift = 2 * far * near / (near - far);
  const float wide = 2.2f * kHeight / kWidth, high = 2.2f;
  // rows of the rotation: (c, 0, s), (s s, c, -c s), (-c s, s, c c)
  const std::array<std::array<float, 3>, 3> r{{{c, 0, s}, {s * s, c, -c * s}, {-c * s, s, c * c}}};
  std::array<float, 16> m{};
  for (std::size_t k = 0; k < 3; ++k) {
    m.at(4 * k) = wide * r[0].at(k);
    m.at(4 * k + 1) = high * r[1].at(k);
    m.at(4 * k + 2) = depth * r[2].at(k);
    m.at(4 * k + 3) = -r[2].at(k);
  }
  m[14] = depth * away + shift;
  m[15] = -away;
  return m;
}

/// Colours and depths that stay from frame to frame.
GLuint framebuffer() {
  std::array<GLuint, 2> buffers{};
  glGenRenderbuffers(2, buffers.data());
  glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kWidth, kHeight);
  glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, kWidth, kHeight);
  GLuint made = 0;
  glGenFramebuffers(1, &made);
  glBindFramebuffer(GL_FRAMEBUFFER, made);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
  return made;
}

void show(GLuint drawn) {
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, kWidth, kHeight, 0, 0, kWidth, kHeight, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, drawn);
}

void draw(GLuint made, int frame, bool clears) {
  const auto set = [made](const char* name) { return glGetUniformLocation(made, name); };
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glClearColor(0.1f, 0.2f, 0.3f, 1.0f);
  if (clears) glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  const std::array<float, 16> matrix = cube_matrix(0.6f + 0.05f * static_cast<float>(frame));
  glUniformMatrix4fv(set("matrix"), 1, GL_FALSE, matrix.data());
  glUniform3f(set("light"), 0.4f, 0.7f, 0.6f);
  glUniform4f(set("tint"), 1, 1, 1, 1);
  glDrawElements(GL_TRIANGLES, 36, GL_UNSIGNED_SHORT, nullptr);
  // In front, mixed with what is there, the right part of it cut away.
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_CULL_FACE);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 60, kHeight);
  const std::array<float, 16> same{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  glUniformMatrix4fv(set("matrix"), 1, GL_FALSE, same.data());
  glUniform4f(set("tint"), 0.5f, 1.0f, 0.6f, 0.5f);
  glDrawElements(GL_TRIANGLES, 6, GL_UNSIGNED_SHORT, reinterpret_cast<const void*>(std::size_t{72}));
}

}  // namespace

int main(int count, char** words) {
  Display* const display = XOpenDisplay(nullptr);
  if (display == nullptr) {
    std::fputs("spinning_cube: no display\n", stderr);
    return 1;
  }
  std::array<int, 7> wanted{GLX_RGBA, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 24, GLX_RED_SIZE, 8, None};
  XVisualInfo* const visual = glXChooseVisual(display, DefaultScreen(display), wanted.data());
  if (visual == nullptr) {
    std::fputs("spinning_cube: no visual\n", stderr);
    return 1;
  }
  const Window root = RootWindow(display, visual->screen);
  XSetWindowAttributes attributes{};
  attributes.colormap = XCreateColormap(display, root, visual->visual, AllocNone);
  const Window window = XCreateWindow(display, root, 0, 0, kWidth, kHeight, 0, visual->depth, InputOutput,
                                      visual->visual, CWColormap, &attributes);
  XMapWindow(display, window);
  glXMakeCurrent(display, window, glXCreateContext(display, visual, nullptr, True));
  const GLuint made = program();
  upload();
  glFinish();  // gfxreconstruct does not see contents of textures that are still under way
  const bool trail = count > 1 && std::strcmp(words[1], "trail") == 0;
  const GLuint target = trail ? framebuffer() : 0;
  for (int frame = 0; frame < 8; ++frame) {
    draw(made, frame, !trail || frame == 0);
    if (trail) show(target);
    glXSwapBuffers(display, window);
  }
  return 0;
}
