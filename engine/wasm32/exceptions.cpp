// Exceptions of C++ over those of WebAssembly: what the compiler calls to throw, to catch and to throw again, and the
// choice of a handler. One thread. The names and the tables are those of the Itanium C++ ABI (level II) and of LLVM's
// document "WebAssembly exception handling".
//
// `throw` makes an object behind a header and raises a WebAssembly exception that holds the address of the header's
// last member. A landing pad gives that address to _Unwind_CallPersonality(), which finds in the function's table which
// handler takes it.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <typeinfo>

// libc++abi's class of all type_infos, whose table of virtual functions has can_catch() in this place.
namespace __cxxabiv1 {
struct __shim_type_info : std::type_info {
  ~__shim_type_info() override;
  virtual void noop1() const;
  virtual void noop2() const;
  virtual bool can_catch(const __shim_type_info* thrown, void*& object) const = 0;
};
}  // namespace __cxxabiv1

namespace {

using TypeInfo = __cxxabiv1::__shim_type_info;

/// Stands before the object that is thrown.
struct alignas(16) Header {
  const TypeInfo* type;
  void* (*destroy)(void*);   ///< in WebAssembly, destructors return their object
  Header* next;              ///< the exception that was being handled before
  int handlers;              ///< how many handle it; negative once it is thrown again
  void* object;              ///< as the handler sees it: a part of the whole, perhaps
  std::uintptr_t raised[2];  ///< its address is what WebAssembly throws

  void* whole() { return this + 1; }
};

Header* handled = nullptr;  // the last exception that is being handled

// For an exception that no memory is left for: std::bad_alloc itself.
alignas(Header) unsigned char last_resort[sizeof(Header) + 64];

Header* header_of_raised(void* raised) {
  return reinterpret_cast<Header*>(static_cast<char*>(raised) - offsetof(Header, raised));
}
Header* header_of_whole(void* whole) { return static_cast<Header*>(whole) - 1; }

[[noreturn]] void raise(Header* header) {
  constexpr int exception_of_cpp = 0;
  __builtin_wasm_throw(exception_of_cpp, &header->raised);
}

/// Reads numbers of LEB128.
class TableReader {
 public:
  explicit TableReader(const std::uint8_t* at) : at_(at) {}
  const std::uint8_t* at() const { return at_; }
  std::uint8_t byte() { return *at_++; }
  std::uintptr_t unsigned_number() {
    int bits = 0;
    return digits(bits);
  }
  std::intptr_t signed_number() {
    int bits = 0;
    std::uintptr_t value = digits(bits);
    if ((at_[-1] & 0x40) && bits < 32) value |= ~std::uintptr_t{0} << bits;
    return static_cast<std::intptr_t>(value);
  }

 private:
  std::uintptr_t digits(int& bits) {
    std::uintptr_t value = 0;
    do {
      if (bits < 32) value |= static_cast<std::uintptr_t>(*at_ & 0x7f) << bits;
      bits += 7;
    } while (*at_++ & 0x80);
    return value;
  }
  const std::uint8_t* at_;
};

/// The table of a function: which actions belong to a landing pad.
class HandlerTable {
 public:
  explicit HandlerTable(const std::uint8_t* table) {
    constexpr std::uint8_t omitted = 0xff;
    TableReader reader(table);
    if (reader.byte() != omitted) std::abort();  // landing pads have no base
    if (reader.byte() != omitted) {
      const std::uintptr_t distance = reader.unsigned_number();
      types_ = reader.at() + distance;
    }
    reader.byte();  // how the pads are written: as numbers of LEB128
    const std::uintptr_t bytes = reader.unsigned_number();
    pads_ = reader.at();
    actions_ = pads_ + bytes;
  }

  /// Returns the number of the handler of this landing pad that takes the exception; 0: none.
  std::intptr_t handler(std::uintptr_t pad, Header& thrown) const {
    TableReader pads(pads_);
    for (std::uintptr_t k = 0; pads.at() < actions_; ++k) {
      pads.unsigned_number();
      const std::uintptr_t action = pads.unsigned_number();
      if (k == pad) return action == 0 ? 0 : first_taker(actions_ + action - 1, thrown);
    }
    return 0;
  }

 private:
  std::intptr_t first_taker(const std::uint8_t* action, Header& thrown) const {
    for (;;) {
      TableReader reader(action);
      const std::intptr_t filter = reader.signed_number();
      if (filter < 0 || (filter > 0 && takes(filter, thrown))) return filter;
      const std::uint8_t* const from = reader.at();
      const std::intptr_t step = reader.signed_number();
      if (step == 0) return 0;
      action = from + step;
    }
  }
  bool takes(std::intptr_t filter, Header& thrown) const {
    const TypeInfo* wanted = nullptr;
    std::memcpy(&wanted, types_ - static_cast<std::intptr_t>(sizeof wanted) * filter, sizeof wanted);
    void* object = thrown.whole();
    if (wanted && !wanted->can_catch(thrown.type, object)) return false;  // null: catch (...)
    thrown.object = object;
    return true;
  }

  const std::uint8_t *types_ = nullptr, *pads_ = nullptr, *actions_ = nullptr;
};

}  // namespace

extern "C" {

/// A landing pad fills it before it calls _Unwind_CallPersonality(), and reads the selector afterwards.
struct LandingPadContext {
  std::uintptr_t pad;
  const std::uint8_t* table;
  std::uintptr_t selector;
};
thread_local LandingPadContext __wasm_lpad_context;

int _Unwind_CallPersonality(void* raised) {
  constexpr int found_a_handler = 6, goes_on = 8;  // _URC_HANDLER_FOUND, _URC_CONTINUE_UNWIND
  __wasm_lpad_context.selector = 0;
  if (!__wasm_lpad_context.table) return goes_on;
  const std::intptr_t handler =
      HandlerTable(__wasm_lpad_context.table).handler(__wasm_lpad_context.pad, *header_of_raised(raised));
  __wasm_lpad_context.selector = static_cast<std::uintptr_t>(handler);
  return handler == 0 ? goes_on : found_a_handler;
}

/// Named by every function that handles exceptions, and called by none.
int __gxx_wasm_personality_v0(...) { std::abort(); }
void _Unwind_DeleteException(void*) {}

void* __cxa_allocate_exception(std::size_t bytes) noexcept {
  void* memory = std::malloc(sizeof(Header) + bytes);
  if (!memory) {
    if (sizeof(Header) + bytes > sizeof last_resort) std::terminate();
    memory = last_resort;
  }
  return (new (memory) Header{})->whole();
}

void __cxa_free_exception(void* whole) noexcept {
  Header* const header = header_of_whole(whole);
  if (static_cast<void*>(header) != last_resort) std::free(header);
}

[[noreturn]] void __cxa_throw(void* whole, std::type_info* type, void* (*destroy)(void*)) {
  Header* const header = header_of_whole(whole);
  header->type = static_cast<const TypeInfo*>(type);
  header->destroy = destroy;
  header->object = whole;
  raise(header);
}

void* __cxa_get_exception_ptr(void* raised) noexcept { return header_of_raised(raised)->object; }

void* __cxa_begin_catch(void* raised) noexcept {
  Header* const header = header_of_raised(raised);
  header->handlers = (header->handlers < 0 ? -header->handlers : header->handlers) + 1;
  if (header != handled) {
    header->next = handled;
    handled = header;
  }
  return header->object;
}

void __cxa_end_catch() {
  Header* const header = handled;
  if (!header) return;
  if (header->handlers < 0) {  // thrown again: it lives on
    if (++header->handlers == 0) handled = header->next;
  } else if (--header->handlers == 0) {
    handled = header->next;
    if (header->destroy) header->destroy(header->whole());
    __cxa_free_exception(header->whole());
  }
}

[[noreturn]] void __cxa_rethrow() {
  if (!handled) std::terminate();
  handled->handlers = -handled->handlers;
  raise(handled);
}

/// Registers a destructor of a thread's variable: there is one thread, which ends with the program.
int __cxa_atexit(void (*destroy)(void*), void* object, void* library);
int __cxa_thread_atexit(void (*destroy)(void*), void* object, void* library) {
  return __cxa_atexit(destroy, object, library);
}

}  // extern "C"

// libc++ is built without exceptions: where it would throw, it calls this function with a sentence about which it was.
namespace std { inline namespace _LIBCPP_ABI_NAMESPACE {
[[noreturn]] void __libcpp_verbose_abort(const char*, ...) { throw std::bad_alloc(); }
}}  // namespace std::_LIBCPP_ABI_NAMESPACE
