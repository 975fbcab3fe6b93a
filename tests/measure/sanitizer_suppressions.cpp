// The system's Embree is not instrumented: the thread sanitizer takes its tree build for races.

extern "C" const char* __tsan_default_suppressions();

extern "C" const char* __tsan_default_suppressions() {
  return "called_from_lib:libembree3.so\n"
         "race:libembree3.so\n";
}
