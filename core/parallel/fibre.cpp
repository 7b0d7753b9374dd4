#include "core/parallel/fibre.h"

#include <cstdint>
#include <exception>
#include <new>
#include <utility>

#include <sys/mman.h>
#include <ucontext.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__)
#define KINGPIN_FIBRE_ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define KINGPIN_FIBRE_ASAN 1
#endif
#endif
#if defined(__SANITIZE_THREAD__)
#define KINGPIN_FIBRE_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define KINGPIN_FIBRE_TSAN 1
#endif
#endif
#ifdef KINGPIN_FIBRE_ASAN
#include <sanitizer/common_interface_defs.h>
#endif
#ifdef KINGPIN_FIBRE_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace kingpin {

struct Fibre::State {
  std::function<void()> body;
  std::byte* memory = nullptr;
  std::size_t memory_bytes = 0;
  std::size_t guard_bytes = 0;
  ucontext_t inside{};
  ucontext_t outside{};
  bool done = false;
  std::exception_ptr error;
  // What the sanitizers must be told so that they follow the change of stacks.
  [[maybe_unused]] void* inside_fake_stack = nullptr;
  [[maybe_unused]] void* outside_fake_stack = nullptr;
  [[maybe_unused]] const void* outside_bottom = nullptr;
  [[maybe_unused]] std::size_t outside_bytes = 0;
  [[maybe_unused]] void* inside_tsan = nullptr;
  [[maybe_unused]] void* outside_tsan = nullptr;

  void SwitchIn() {
#ifdef KINGPIN_FIBRE_ASAN
    __sanitizer_start_switch_fiber(&outside_fake_stack, memory + guard_bytes,
                                   memory_bytes - guard_bytes);
#endif
#ifdef KINGPIN_FIBRE_TSAN
    outside_tsan = __tsan_get_current_fiber();
    __tsan_switch_to_fiber(inside_tsan, 0);
#endif
    swapcontext(&outside, &inside);
#ifdef KINGPIN_FIBRE_ASAN
    __sanitizer_finish_switch_fiber(outside_fake_stack, nullptr, nullptr);
#endif
  }

  void SwitchOut(bool for_good) {
    (void)for_good;
#ifdef KINGPIN_FIBRE_ASAN
    __sanitizer_start_switch_fiber(for_good ? nullptr : &inside_fake_stack, outside_bottom,
                                   outside_bytes);
#endif
#ifdef KINGPIN_FIBRE_TSAN
    __tsan_switch_to_fiber(outside_tsan, 0);
#endif
    swapcontext(&inside, &outside);
    Arrive();
  }

  void Arrive() {
#ifdef KINGPIN_FIBRE_ASAN
    __sanitizer_finish_switch_fiber(inside_fake_stack, &outside_bottom, &outside_bytes);
#endif
  }
};

Fibre::Fibre(std::function<void()> body, std::size_t stack_bytes)
    : state_(std::make_unique<State>()) {
  state_->body = std::move(body);
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  state_->guard_bytes = page;
  state_->memory_bytes = (stack_bytes + page - 1) / page * page + page;
  void* memory = mmap(nullptr, state_->memory_bytes, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_STACK, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  state_->memory = static_cast<std::byte*>(memory);
  mprotect(memory, page, PROT_NONE);
  getcontext(&state_->inside);
  state_->inside.uc_stack.ss_sp = state_->memory + page;
  state_->inside.uc_stack.ss_size = state_->memory_bytes - page;
  state_->inside.uc_link = nullptr;
  const auto address = reinterpret_cast<std::uintptr_t>(state_.get());
  // makecontext passes ints only, hence the pointer in two halves.
  makecontext(&state_->inside, reinterpret_cast<void (*)()>(&Fibre::Enter), 2,
              static_cast<unsigned>(address >> 32), static_cast<unsigned>(address));
#ifdef KINGPIN_FIBRE_TSAN
  state_->inside_tsan = __tsan_create_fiber(0);
#endif
}

Fibre::~Fibre() {
#ifdef KINGPIN_FIBRE_TSAN
  __tsan_destroy_fiber(state_->inside_tsan);
#endif
  munmap(state_->memory, state_->memory_bytes);
}

void Fibre::Enter(unsigned high, unsigned low) {
  auto* state = reinterpret_cast<State*>((static_cast<std::uintptr_t>(high) << 32) | low);
  state->Arrive();
  try {
    state->body();
  } catch (...) {
    state->error = std::current_exception();
  }
  state->done = true;
  state->SwitchOut(true);
}

void Fibre::Resume() {
  if (state_->done) return;
  state_->SwitchIn();
  if (state_->error) std::rethrow_exception(std::exchange(state_->error, nullptr));
}

void Fibre::Yield() { state_->SwitchOut(false); }

bool Fibre::done() const { return state_->done; }

}  // namespace kingpin
