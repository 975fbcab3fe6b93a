#include <varifold/render/gl_objects.h>

#include <algorithm>
#include <array>
#include <string>

namespace varifold::gl {
namespace {

std::string first_line(std::string text) {
  text.resize(std::min(text.find('\n'), text.size()));
  return text;
}

Result<void> compile(GLuint shader, const ShaderStage& stage) {
  constexpr std::string_view kVersion = "#version 450 core\n";
  const std::array<std::string_view, 3> texts = {kVersion, stage.defines, stage.source};
  std::array<const GLchar*, 3> parts{};
  std::array<GLint, 3> lengths{};
  for (std::size_t i = 0; i < texts.size(); ++i) {
    parts[i] = texts[i].data();
    lengths[i] = static_cast<GLint>(texts[i].size());
  }
  glShaderSource(shader, static_cast<GLsizei>(parts.size()), parts.data(), lengths.data());
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled) return {};
  std::array<GLchar, 1024> log{};
  glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
  return fail(ErrorKind::kFailed, "cannot compile: " + first_line(log.data()));
}

Result<void> link(GLuint program) {
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked) return {};
  std::array<GLchar, 1024> log{};
  glGetProgramInfoLog(program, log.size(), nullptr, log.data());
  return fail(ErrorKind::kFailed, "cannot link: " + first_line(log.data()));
}

GLint location(const Program& program, const char* name) {
  return glGetUniformLocation(program.name(), name);
}

}  // namespace

void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }
void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
void delete_texture(GLuint name) { glDeleteTextures(1, &name); }
void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
void delete_program(GLuint name) { glDeleteProgram(name); }

Buffer make_buffer() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return Buffer(name);
}

VertexArray make_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return VertexArray(name);
}

Framebuffer make_framebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return Framebuffer(name);
}

Texture make_texture(GLenum format, const TextureSize& size) {
  GLuint name = 0;
  if (size.samples > 1) {
    glCreateTextures(GL_TEXTURE_2D_MULTISAMPLE, 1, &name);
    glTextureStorage2DMultisample(name, size.samples, format, size.width, size.height, GL_TRUE);
  } else {
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    glTextureStorage2D(name, 1, format, size.width, size.height);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  return Texture(name);
}

Result<Program> make_program(std::string_view name, std::initializer_list<ShaderStage> stages) {
  Program program(glCreateProgram());
  for (const ShaderStage& stage : stages) {
    const GLuint shader = glCreateShader(stage.type);
    auto compiled = compile(shader, stage);
    glAttachShader(program.name(), shader);
    glDeleteShader(shader);  // lives on while the program holds it
    if (!compiled) return fail_in("shader " + std::string(name), std::move(compiled.error()));
  }
  if (auto linked = link(program.name()); !linked)
    return fail_in("shader " + std::string(name), std::move(linked.error()));
  return program;
}

Result<void> assign(Program& target, Result<Program> made) {
  if (!made) return tl::unexpected<Error>(std::move(made.error()));
  target = std::move(*made);
  return {};
}

void set_uniform(const Program& program, const char* name, int value) {
  glProgramUniform1i(program.name(), location(program, name), value);
}
void set_uniform(const Program& program, const char* name, float value) {
  glProgramUniform1f(program.name(), location(program, name), value);
}
void set_uniform(const Program& program, const char* name, const Vec2& value) {
  glProgramUniform2fv(program.name(), location(program, name), 1, &value.x);
}
void set_uniform(const Program& program, const char* name, const Vec3& value) {
  glProgramUniform3fv(program.name(), location(program, name), 1, &value.x);
}
void set_uniform(const Program& program, const char* name, const Vec4& value) {
  glProgramUniform4fv(program.name(), location(program, name), 1, &value.x);
}
void set_uniform(const Program& program, const char* name, const glm::mat4& value) {
  glProgramUniformMatrix4fv(program.name(), location(program, name), 1, GL_FALSE, &value[0].x);
}

Result<void> check_errors(std::string_view step) {
  GLenum first = GL_NO_ERROR;
  // Bounded: a lost context reports errors for ever.
  for (int i = 0; i < 32; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    if (first == GL_NO_ERROR) first = error;
  }
  if (first == GL_NO_ERROR) return {};
  std::string reason = "error " + std::to_string(first);
  if (first == GL_OUT_OF_MEMORY) reason = "out of graphics memory";
  return fail(ErrorKind::kFailed, "OpenGL, " + std::string(step) + ": " + reason);
}

}  // namespace varifold::gl
