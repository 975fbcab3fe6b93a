#include <varifold/render/headless_context.h>

// epoxy/egl.h would drag in the X11 headers, with their macros.
#define EGL_NO_X11               // NOLINT(readability-identifier-naming)
#define MESA_EGL_NO_X11_HEADERS  // NOLINT(readability-identifier-naming)
#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace varifold {

struct HeadlessContext::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::string description;

  ~Impl() {
    if (context == EGL_NO_CONTEXT) return;
    if (eglGetCurrentContext() == context)
      eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    // No eglTerminate: EGL hands out one display per process, and it may have other contexts.
  }
};

namespace {

constexpr int kMajor = 4, kMinor = 5;

tl::unexpected<Error> no_context(const std::string& why) {
  return fail(ErrorKind::kFailed, "no OpenGL without a window: " + why);
}

/// libepoxy ends the process when a library is missing altogether, so look before it does.
bool can_load(const char* library) {
  void* handle = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
  if (handle) dlclose(handle);
  return handle != nullptr;
}

bool has_word(const char* words, std::string_view wanted) {
  std::string_view rest = words ? words : "";
  while (!rest.empty()) {
    const std::size_t end = rest.find(' ');
    if (rest.substr(0, end) == wanted) return true;
    if (end == std::string_view::npos) return false;
    rest.remove_prefix(end + 1);
  }
  return false;
}

bool software_only(const HeadlessOptions& options) {
  const char* wish = std::getenv("LIBGL_ALWAYS_SOFTWARE");
  return options.software || (wish && std::string_view(wish) == "1");
}

/// The displays of the GPUs that EGL knows.
std::vector<EGLDisplay> gpu_displays(const char* client_extensions) {
  std::vector<EGLDisplay> displays;
  if (!has_word(client_extensions, "EGL_EXT_platform_device") ||
      !has_word(client_extensions, "EGL_EXT_device_enumeration") ||
      !has_word(client_extensions, "EGL_EXT_device_query"))
    return displays;
  std::array<EGLDeviceEXT, 32> devices{};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) return {};
  for (EGLint i = 0; i < count; ++i) {
    const char* words = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
    if (has_word(words, "EGL_MESA_device_software")) continue;
    displays.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
  }
  return displays;
}

/// Every display worth trying, best first.
std::vector<EGLDisplay> candidate_displays(const HeadlessOptions& options) {
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::vector<EGLDisplay> displays;
  if (has_word(extensions, "EGL_EXT_platform_base")) {
    if (!software_only(options)) displays = gpu_displays(extensions);
    if (has_word(extensions, "EGL_MESA_platform_surfaceless"))
      displays.push_back(
          eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  }
  displays.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  std::erase(displays, EGL_NO_DISPLAY);
  return displays;
}

EGLContext create_context(EGLDisplay display) {
  if (!eglBindAPI(EGL_OPENGL_API)) return EGL_NO_CONTEXT;
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  if (!has_word(extensions, "EGL_KHR_surfaceless_context")) return EGL_NO_CONTEXT;
  // No surface is ever made, so any configuration that knows OpenGL will do.
  const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) {
    if (!has_word(extensions, "EGL_KHR_no_config_context")) return EGL_NO_CONTEXT;
    config = nullptr;
  }
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               kMajor,
                               EGL_CONTEXT_MINOR_VERSION,
                               kMinor,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
  return eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
}

std::string describe_current() {
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const int version = epoxy_gl_version();
  return std::string(renderer ? renderer : "unknown") + ", OpenGL " + std::to_string(version / 10) +
         "." + std::to_string(version % 10);
}

}  // namespace

Result<HeadlessContext> HeadlessContext::create(const HeadlessOptions& options) {
  if (!can_load("libEGL.so.1")) return no_context("libEGL.so.1 is not installed (libegl1)");
  if (!can_load("libOpenGL.so.0") && !can_load("libGL.so.1"))
    return no_context("libGL.so.1 is not installed (libgl1)");

  bool any_display = false;
  for (const EGLDisplay display : candidate_displays(options)) {
    EGLint major = 0, minor = 0;
    if (!eglInitialize(display, &major, &minor)) continue;
    any_display = true;
    auto impl = std::make_unique<Impl>();
    impl->display = display;
    impl->context = create_context(display);
    if (impl->context == EGL_NO_CONTEXT) continue;
    HeadlessContext context(std::move(impl));
    if (!context.make_current()) continue;
    context.impl_->description = describe_current();
    return context;
  }
  if (!any_display)
    return no_context(
        "no EGL display: is libegl1 with Mesa (libegl-mesa0, libgl1-mesa-dri) there?");
  return no_context("no driver here offers OpenGL 4.5 core");
}

Result<void> HeadlessContext::make_current() const {
  if (!eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context))
    return no_context("the context cannot be made current");
  return {};
}

const std::string& HeadlessContext::description() const { return impl_->description; }

HeadlessContext::HeadlessContext(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HeadlessContext::HeadlessContext(HeadlessContext&&) noexcept = default;
HeadlessContext& HeadlessContext::operator=(HeadlessContext&&) noexcept = default;
HeadlessContext::~HeadlessContext() = default;

}  // namespace varifold
