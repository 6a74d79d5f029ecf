// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/view_mesh.hpp"
#include "serve/store.hpp"
#include "serve/workers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <set>
#include <string>
#include <thread>

namespace rhizodont::serve {
namespace {

TEST(Store, MakesPlaceByWhatWasNotAskedForTheLongest) {
  Store<int> store(2, std::chrono::seconds(100));
  EXPECT_TRUE(store.add("a", std::make_shared<int>(1)));
  EXPECT_TRUE(store.add("b", std::make_shared<int>(2)));
  EXPECT_EQ(*store.find("a"), 1);
  EXPECT_TRUE(store.add("c", std::make_shared<int>(3)));
  EXPECT_FALSE(store.find("b"));
  EXPECT_TRUE(store.find("a"));
  EXPECT_EQ(*store.take("c"), 3);
  EXPECT_FALSE(store.take("c"));
}

TEST(Store, KeepsWhatMayNotGoAndForgetsWhatIsOld) {
  Store<int> busy(1, std::chrono::seconds(0), [](const int& thing) { return thing != 7; });
  EXPECT_TRUE(busy.add("a", std::make_shared<int>(7)));
  EXPECT_FALSE(busy.add("b", std::make_shared<int>(8)));
  EXPECT_TRUE(busy.find("a"));
  Store<int> old(4, std::chrono::seconds(0));
  EXPECT_TRUE(old.add("a", std::make_shared<int>(1)));
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  old.expire();
  EXPECT_EQ(old.size(), 0U);
}

TEST(RandomIds, DoNotRepeat) {
  std::set<std::string> ids;
  for (int i = 0; i < 1000; ++i) ids.insert(random_id());
  EXPECT_EQ(ids.size(), 1000U);
  EXPECT_EQ(ids.begin()->size(), 32U);
}

TEST(Workers, RefuseWhatTheQueueCannotHoldAndPutTheUrgentFirst) {
  Workers workers(1, 2);
  std::promise<void> go;
  std::shared_future<void> gone = go.get_future().share();
  std::promise<void> begun;
  ASSERT_TRUE(workers.add([&] {
    begun.set_value();
    gone.wait();
  }));
  begun.get_future().wait();
  std::string order;
  std::promise<void> all;
  EXPECT_TRUE(workers.add([&] {
    order += "b";
    all.set_value();
  }));
  EXPECT_TRUE(workers.add([&] { order += "a"; }, true));
  EXPECT_FALSE(workers.add([] {}));
  go.set_value();
  all.get_future().wait();
  EXPECT_EQ(order, "ab");
}

TEST(ViewBytes, CountFromTheMiddleInMillimetres) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 2, 3}, {2, 2, 3}, {1, 3, 3}};
  mesh.triangles = {{0, 1, 2}};
  const std::string bytes = view_bytes({&mesh, Point(1, 2, 3), 10, {{"n", {5, 6, 7}}}, {}});
  ASSERT_EQ(bytes.substr(0, 4), "RZV1");
  EXPECT_EQ(bytes.size() % 4, 0U);
  EXPECT_NE(bytes.find("\"centre_mm\":[10.0,20.0,30.0]"), std::string::npos);
  const float* numbers = reinterpret_cast<const float*>(bytes.data() + bytes.size() - 4 * (9 + 3 + 3));
  EXPECT_EQ(numbers[0], 0.0F);
  EXPECT_EQ(numbers[3], 10.0F);
  EXPECT_EQ(numbers[14], 7.0F);
}

}  // namespace
}  // namespace rhizodont::serve
