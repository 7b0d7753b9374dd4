#include "core/parallel/fibre.h"

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace kingpin {
namespace {

TEST(Fibre, TwoFibresTakeTurnsAndKeepTheirOwnState) {
  std::string log;
  std::unique_ptr<Fibre> a, b;
  a = std::make_unique<Fibre>([&] {
    for (int i = 0; i < 3; ++i) {
      log.append("a").append(std::to_string(i));
      a->Yield();
    }
  });
  b = std::make_unique<Fibre>([&] {
    for (int i = 0; i < 2; ++i) {
      log.append("b").append(std::to_string(i));
      b->Yield();
    }
  });
  while (!a->done() || !b->done()) {
    a->Resume();
    b->Resume();
  }
  EXPECT_EQ(log, "a0b0a1b1a2");
}

TEST(Fibre, AnExceptionLeavesThroughResume) {
  std::unique_ptr<Fibre> fibre;
  fibre = std::make_unique<Fibre>([&] {
    const std::vector<int> destroyed_on_the_way(100, 1);
    fibre->Yield();
    throw std::runtime_error("inside");
  });
  fibre->Resume();
  EXPECT_FALSE(fibre->done());
  EXPECT_THROW(fibre->Resume(), std::runtime_error);
  EXPECT_TRUE(fibre->done());
  fibre->Resume();  // does nothing
}

TEST(Fibre, ExceptionsHandledInsideOneFibreDoNotDisturbAnother) {
  int caught = 0;
  std::vector<std::unique_ptr<Fibre>> fibres;
  for (int i = 0; i < 8; ++i) {
    fibres.push_back(std::make_unique<Fibre>([&, i] {
      for (int k = 0; k < 10; ++k) {
        bool was_caught = false;
        try {
          fibres[i]->Yield();
          throw std::runtime_error(std::to_string(i));
        } catch (const std::runtime_error& error) {
          was_caught = error.what() == std::to_string(i);
        }
        caught += was_caught ? 1 : 0;
        fibres[i]->Yield();
      }
    }));
  }
  for (bool any = true; any;) {
    any = false;
    for (auto& fibre : fibres) {
      fibre->Resume();
      any = any || !fibre->done();
    }
  }
  EXPECT_EQ(caught, 80);
}

}  // namespace
}  // namespace kingpin
