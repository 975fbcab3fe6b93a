// Private to this folder: OpenGL names that delete themselves, and shader programs.
#pragma once

#include <epoxy/gl.h>

#include <varifold/base/math.h>
#include <varifold/base/result.h>
#include <glm/mat4x4.hpp>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace varifold::gl {

/// Owns one OpenGL name; 0 is none. The context must be current when it is deleted.
template <void (*Delete)(GLuint)>
class Object {
 public:
  Object() = default;
  explicit Object(GLuint name) : name_(name) {}
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Object() {
    if (name_) Delete(name_);
  }
  [[nodiscard]] GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

void delete_buffer(GLuint name);
void delete_vertex_array(GLuint name);
void delete_texture(GLuint name);
void delete_framebuffer(GLuint name);
void delete_program(GLuint name);

using Buffer = Object<delete_buffer>;
using VertexArray = Object<delete_vertex_array>;
using Texture = Object<delete_texture>;
using Framebuffer = Object<delete_framebuffer>;
using Program = Object<delete_program>;

[[nodiscard]] Buffer make_buffer();
[[nodiscard]] VertexArray make_vertex_array();
[[nodiscard]] Framebuffer make_framebuffer();

/// Storage of a texture of one level; `samples` above 1 makes it multisampled.
struct TextureSize {
  int width = 0;
  int height = 0;
  int samples = 1;
  friend bool operator==(const TextureSize&, const TextureSize&) = default;
};
[[nodiscard]] Texture make_texture(GLenum format, const TextureSize& size);

struct ShaderStage {
  GLenum type;
  std::string_view source;        ///< without the #version line
  std::string_view defines = "";  ///< comes before the source
};

/// Compiles and links; kFailed with the first line of the compiler's message. `name` is for that.
[[nodiscard]] Result<Program> make_program(std::string_view name,
                                           std::initializer_list<ShaderStage> stages);

/// Moves a program to its place, or hands on the error.
[[nodiscard]] Result<void> assign(Program& target, Result<Program> made);

/// Sets a uniform by name; does nothing where the program has no such uniform.
void set_uniform(const Program& program, const char* name, int value);
void set_uniform(const Program& program, const char* name, float value);
void set_uniform(const Program& program, const char* name, const Vec2& value);
void set_uniform(const Program& program, const char* name, const Vec3& value);
void set_uniform(const Program& program, const char* name, const Vec4& value);
void set_uniform(const Program& program, const char* name, const glm::mat4& value);

/// Empties the queue of errors; kFailed, naming the step, when there was one.
[[nodiscard]] Result<void> check_errors(std::string_view step);

}  // namespace varifold::gl
