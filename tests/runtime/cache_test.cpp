#include "runtime/cache.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "runtime/load_plugin.hpp"
#include "runtime/tool_error.hpp"
#include "tests/runtime/oscillator.hpp"

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;
using tests::count_entries;
using tests::Environment;
using tests::oscillator;
using tests::script;
using tests::text_of;
using tests::write_text;

class CacheTest : public testing::Test {
 protected:
  // The real compiler behind a script that counts how often it is called.
  Compiler counting_compiler() const {
    const std::string real = find_compiler().command.front();
    return find_compiler(script(root() / "counting", "echo >> '" + calls_path().string() +
                                                         "'\nexec '" + real + "' \"$@\""));
  }

  std::size_t calls() const { return text_of(calls_path()).size(); }
  fs::path calls_path() const { return root() / "calls"; }
  const fs::path& root() const { return directory_.path(); }
  fs::path cache_path() const { return root() / "parent" / "cache"; }

  // Each loading works, whatever the cache is like.
  static void expect_works(const LoadedPlugin& plugin) {
    ASSERT_NE(plugin.library, nullptr);
    EXPECT_STREQ(plugin.library->plugin().description, "oscillator, stormer-verlet");
  }

  // Loads the oscillator with a cache that must be refused for this reason.
  void expect_uncached(const Cache& cache, const std::string& reason) const {
    const LoadedPlugin plugin = load_plugin(oscillator(), find_compiler(), {}, cache);
    expect_works(plugin);
    EXPECT_FALSE(plugin.from_cache);
    ASSERT_EQ(plugin.warnings.size(), 1u);
    EXPECT_EQ(plugin.warnings.front(),
              "the cache '" + cache.directory.string() + "' is not used: " + reason);
    EXPECT_TRUE(list_cache(cache).empty());
  }

  TemporaryDirectory directory_ = private_directory();
};

// Objects that take the same steps.
TEST_F(CacheTest, TakesWhatWasOptimisedMoreButNotLess) {
  const Cache cache = open_cache(cache_path());
  const auto load = [&](const std::string& asked) {
    const LoadedPlugin plugin =
        load_plugin(oscillator(), find_compiler(), {.optimisation = asked}, cache);
    expect_works(plugin);
    return std::pair(plugin.optimisation, plugin.from_cache);
  };
  EXPECT_EQ(load("-O1"), std::pair(std::string("-O1"), false));
  EXPECT_EQ(load("-O1"), std::pair(std::string("-O1"), true));
  EXPECT_EQ(load("-O3"), std::pair(std::string("-O3"), false));
  EXPECT_EQ(load("-O1"), std::pair(std::string("-O3"), true));
}

TEST_F(CacheTest, FollowsTheEnvironment) {
  const Environment home("HOME", "/home/someone");
  const Environment mine("HAMGEN_CACHE", "/mine");
  const Environment base("XDG_CACHE_HOME", "/base");
  EXPECT_EQ(default_cache_directory(), "/mine");
  const Environment no_mine("HAMGEN_CACHE", "");
  EXPECT_EQ(default_cache_directory(), "/base/hamgen");
  const Environment relative_base("XDG_CACHE_HOME", "base");
  EXPECT_EQ(default_cache_directory(), "/home/someone/.cache/hamgen");
  const Environment no_base("XDG_CACHE_HOME", std::nullopt);
  EXPECT_EQ(default_cache_directory(), "/home/someone/.cache/hamgen");
  const Environment no_home("HOME", std::nullopt);
  EXPECT_EQ(default_cache_directory(), "");
  EXPECT_EQ(open_cache().problem, "no cache: neither HAMGEN_CACHE nor HOME is set");
}

TEST_F(CacheTest, IsPrivateWhateverTheUmask) {
  const mode_t old = ::umask(0);
  const Cache cache = open_cache(cache_path());
  const LoadedPlugin plugin = load_plugin(oscillator(), find_compiler(), {}, cache);
  ::umask(old);
  EXPECT_EQ(cache.problem, "");
  struct stat info {};
  ASSERT_EQ(::stat(cache.directory.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0700u);
  ASSERT_EQ(::stat((cache.directory / (plugin.key + ".so")).c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600u);
}

TEST_F(CacheTest, HitDoesNotCallTheCompiler) {
  const Compiler compiler = counting_compiler();
  const Cache cache = open_cache(cache_path());
  const LoadedPlugin first = load_plugin(oscillator(), compiler, {}, cache);
  expect_works(first);
  EXPECT_FALSE(first.from_cache);
  EXPECT_GT(first.compile_seconds, 0.0);
  EXPECT_TRUE(first.warnings.empty());
  EXPECT_EQ(calls(), 1u);
  EXPECT_EQ(count_entries(cache.directory), 1u);

  const LoadedPlugin second = load_plugin(oscillator(), compiler, {}, open_cache(cache_path()));
  expect_works(second);
  EXPECT_TRUE(second.from_cache);
  EXPECT_EQ(second.key, first.key);
  EXPECT_EQ(second.compile_seconds, 0.0);
  EXPECT_EQ(calls(), 1u);
}

TEST_F(CacheTest, KeyDependsOnEverythingThatMakesTheObject) {
  const Compiler compiler{.command = {"/bin/g++"}, .identity = "one", .chosen_by = ""};
  const std::string key = cache_key(oscillator(), compiler, {});
  EXPECT_EQ(key.size(), 64u);
  EXPECT_EQ(cache_key(oscillator(), compiler, {.time_limit = std::chrono::seconds(1)}), key);

  PluginSource other_text = oscillator();
  other_text.text += "\n";
  EXPECT_NE(cache_key(other_text, compiler, {}), key);
  PluginSource other_header = oscillator();
  other_header.headers.push_back({.name = "a.hpp", .text = "b"});
  EXPECT_NE(cache_key(other_header, compiler, {}), key);
  PluginSource with_eigen = oscillator();
  with_eigen.uses_eigen = true;
  EXPECT_NE(cache_key(with_eigen, compiler, {}), key);
  EXPECT_NE(cache_key(oscillator(), compiler, {.extra_flags = {"-O3"}}), key);
  const Compiler other{.command = {"/bin/g++"}, .identity = "two", .chosen_by = ""};
  EXPECT_NE(cache_key(oscillator(), other, {}), key);
}

TEST_F(CacheTest, RecompilesAnObjectThatIsDamaged) {
  const Compiler compiler = counting_compiler();
  const Cache cache = open_cache(cache_path());
  const std::string key = load_plugin(oscillator(), compiler, {}, cache).key;
  const fs::path object = cache.directory / (key + ".so");
  const std::string good = text_of(object);
  std::string flipped = good;
  flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 1);
  std::size_t expected_calls = 1;
  for (const std::string& bad : {good.substr(0, good.size() / 2), good.substr(0, good.size() - 1),
                                 std::string(), good + "x", flipped}) {
    write_text(object, bad);
    const LoadedPlugin plugin = load_plugin(oscillator(), compiler, {}, cache);
    expect_works(plugin);
    EXPECT_FALSE(plugin.from_cache);
    EXPECT_EQ(calls(), ++expected_calls);
    EXPECT_TRUE(find_object(cache, key).has_value());
  }
}

TEST_F(CacheTest, DoesNotTakeAnIntactObjectUnderAnotherKey) {
  const Cache cache = open_cache(cache_path());
  const std::string key = load_plugin(oscillator(), find_compiler(), {}, cache).key;
  const std::string other(64, 'a');
  fs::copy_file(cache.directory / (key + ".so"), cache.directory / (other + ".so"));
  EXPECT_TRUE(find_object(cache, key).has_value());
  EXPECT_FALSE(find_object(cache, other).has_value());
}

TEST_F(CacheTest, RecompilesAnIntactObjectThatIsNoPlugin) {
  const Cache cache = open_cache(cache_path());
  const std::string key = cache_key(oscillator(), find_compiler(), {});
  write_text(cache.directory / "object", "not a shared object");
  publish_object(cache, key, cache.directory / "object");
  ASSERT_TRUE(find_object(cache, key).has_value());
  expect_works(load_plugin(oscillator(), find_compiler(), {}, cache));
  EXPECT_TRUE(load_plugin(oscillator(), find_compiler(), {}, cache).from_cache);
}

TEST_F(CacheTest, HoldsNothingAfterAFailedCompilation) {
  const Cache cache = open_cache(cache_path());
  const PluginSource wrong{.text = "this is not C++"};
  EXPECT_THROW((void)load_plugin(wrong, find_compiler(), {}, cache), ToolError);
  const PluginSource no_entry{.text = "int f() { return 1; }"};
  EXPECT_THROW((void)load_plugin(no_entry, find_compiler(), {}, cache), ToolError);
  EXPECT_EQ(count_entries(cache.directory), 0u);
}

TEST_F(CacheTest, ThatOthersMayWriteIsRefusedAtEveryUse) {
  const Cache opened = open_cache(cache_path());
  ASSERT_TRUE(opened.usable());
  const std::string reason = "other users may write to it (chmod go-w would repair that)";
  ::chmod(cache_path().c_str(), 0777);
  expect_uncached(open_cache(cache_path()), reason);
  expect_uncached(opened, reason);
  EXPECT_FALSE(find_object(opened, std::string(64, 'a')).has_value());
  EXPECT_EQ(count_entries(cache_path()), 0u);
}

TEST_F(CacheTest, ThatIsALinkIsRefusedWithAndWithoutASlash) {
  fs::create_directory(root() / "real");
  fs::create_directory(root() / "parent");
  fs::create_directory_symlink(root() / "real", cache_path());
  expect_uncached(open_cache(cache_path()), "it is a symbolic link");
  expect_uncached(open_cache(cache_path().string() + "/"), "it is a symbolic link");
  expect_uncached(open_cache(cache_path().string() + "/."), "it is a symbolic link");
  EXPECT_EQ(count_entries(root() / "real"), 0u);
}

// Root may write anywhere: a plain file in the directory's place stands for what cannot be written.
TEST_F(CacheTest, ThatCannotBeWrittenCostsAWarningOnly) {
  fs::create_directory(root() / "parent");
  write_text(cache_path(), "in the way");
  expect_uncached(open_cache(cache_path()), "it is not a directory");
  EXPECT_EQ(text_of(cache_path()), "in the way");
  expect_uncached(open_cache(cache_path() / "below"), "Not a directory");
  if (::geteuid() == 0) return;
  fs::create_directory(root() / "locked");
  ::chmod((root() / "locked").c_str(), 0500);
  expect_uncached(open_cache(root() / "locked"), "Permission denied");
  expect_uncached(open_cache(root() / "locked" / "cache"), "Permission denied");
}

TEST_F(CacheTest, ObjectThatOthersMayWriteIsNotLoaded) {
  const Cache cache = open_cache(cache_path());
  const std::string key = load_plugin(oscillator(), find_compiler(), {}, cache).key;
  ::chmod((cache.directory / (key + ".so")).c_str(), 0666);
  EXPECT_FALSE(find_object(cache, key).has_value());
}

TEST_F(CacheTest, ListsPrunesTheOldestAndClears) {
  const Cache cache = open_cache(cache_path());
  const fs::file_time_type now = fs::file_time_type::clock::now();
  for (const char name : {'a', 'b', 'c'}) {
    const fs::path path = cache.directory / (std::string(64, name) + ".so");
    write_text(path, std::string(100, 'x'));
    fs::last_write_time(path, now - std::chrono::hours(name - 'a'));
  }
  write_text(cache.directory / "notes.txt", "mine");
  fs::create_directory(cache.directory / ".build-fresh");
  fs::create_directory(cache.directory / ".build-old");
  fs::last_write_time(cache.directory / ".build-old", now - std::chrono::hours(25));

  const std::vector<CacheEntry> list = list_cache(cache);
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list.front().key, std::string(64, 'a'));
  EXPECT_EQ(list.front().bytes, 100u);
  EXPECT_EQ(list.back().key, std::string(64, 'c'));

  const CacheRemoval pruned = prune_cache(cache, 250);
  EXPECT_EQ(pruned.entries, 1u);
  EXPECT_EQ(pruned.bytes, 100u);
  EXPECT_EQ(list_cache(cache).size(), 2u);
  EXPECT_EQ(list_cache(cache).back().key, std::string(64, 'b'));
  EXPECT_FALSE(fs::exists(cache.directory / ".build-old"));
  EXPECT_TRUE(fs::exists(cache.directory / ".build-fresh"));

  EXPECT_EQ(clear_cache(cache).entries, 2u);
  EXPECT_EQ(count_entries(cache.directory), 1u);
  EXPECT_EQ(text_of(cache.directory / "notes.txt"), "mine");
}

TEST_F(CacheTest, NamesWhatItKeepsAndTrustsNoRecord) {
  const Cache cache = open_cache(cache_path());
  PluginSource source = oscillator();
  const std::string key = load_plugin(source, find_compiler(), {}, cache).key;
  EXPECT_FALSE(find_record(cache, key).has_value());  // nobody said what it is
  source.model = "two\nlines";
  source.scheme = "stormer-verlet";
  const LoadedPlugin again = load_plugin(source, find_compiler(), {}, cache);
  EXPECT_EQ(again.key, key);
  EXPECT_TRUE(again.from_cache);
  const auto record = find_record(cache, key);
  ASSERT_TRUE(record.has_value());
  EXPECT_EQ(record->model, "two lines");
  EXPECT_EQ(record->scheme, "stormer-verlet");
  EXPECT_EQ(record->made.size(), 10u);
  EXPECT_EQ(list_cache(cache).size(), 1u);

  const fs::path place = cache.directory / (key + ".about");
  const std::string good = text_of(place);
  std::string changed = good;
  changed[0] = 'T';
  for (const std::string& bad : {std::string(), good.substr(1), good.substr(0, good.size() - 1),
                                 changed, std::string(1 << 20, 'x')}) {
    write_text(place, bad);
    EXPECT_FALSE(find_record(cache, key).has_value());
    EXPECT_TRUE(load_plugin(source, find_compiler(), {}, cache).from_cache);
  }
  // Of another entry, or a link to a file that is not the cache's: that stays what it is.
  const std::string other(64, 'a');
  write_text(cache.directory / (other + ".about"), good);
  EXPECT_FALSE(find_record(cache, other).has_value());
  write_text(root() / "mine", good);
  fs::remove(place);
  fs::create_symlink(root() / "mine", place);
  EXPECT_FALSE(find_record(cache, key).has_value());
  publish_record(cache, key, {.model = "m", .scheme = "s", .made = {}});
  EXPECT_EQ(find_record(cache, key)->model, "m");
  EXPECT_EQ(text_of(root() / "mine"), good);
  clear_cache(cache);
  EXPECT_EQ(count_entries(cache.directory), 0u);
}

}  // namespace
}  // namespace hamgen::runtime
