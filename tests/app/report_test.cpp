// hamgen report: its files, and the page in a browser.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "runtime/process.hpp"
#include "runtime/tool_error.hpp"
#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

// What a page says: letters of embedded fonts and pictures may spell anything, the name of a folder
// too.
std::string without_data(std::string page) {
  const std::string mark = ";base64,";
  std::size_t begin = 0;
  while ((begin = page.find(mark, begin)) != std::string::npos) {
    begin += mark.size();
    const std::size_t end = page.find_first_not_of(
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=", begin);
    page.erase(begin, std::min(end, page.size()) - begin);
  }
  return page;
}

Result report(const std::string& model, const std::string& directory,
              std::vector<std::string> more = {}) {
  std::vector<std::string> words = {"report",  model,       "-o",
                                    directory, "--rounds",  "1",
                                    "--quiet", "--schemes", "implicit-midpoint,stormer-verlet"};
  words.insert(words.end(), more.begin(), more.end());
  return hamgen(words);
}

TEST(Report, IsOnePageWithItsPicturesAndScripts) {
  const Scratch scratch;
  const std::string directory = scratch.path("out");
  const Result result = report(scratch.write("m.ham", pendulum), directory);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, directory + "/report.html\n");
  const std::string page = without_data(read(directory + "/report.html"));
  ASSERT_GT(page.size(), 50'000U);
  for (const char* part :
       {"<math", "symplectic", "proved",
        "<mo stretchy='false'>|</mo><mi>H</mi><mo form='infix'>−</mo>", "ns/step",
        "The emitted step", "cost", "torn out", "hamgen generate", "Linear stability", "<mi>θ</mi>",
        "<mi>atan</mi>", "The modified Hamiltonian",
        "<msup><mrow><mi>h</mi></mrow><mrow><mn>4</mn></mrow></msup>",
        "<th class='number'>q error</th>"})
    EXPECT_TRUE(contains(page, part)) << part;
  for (const char* name :
       {"portrait", "energy", "energy_zoom", "state", "bench_energy", "bench_state"}) {
    for (const char* ending : {".svg", ".png", ".gp"})
      EXPECT_TRUE(std::filesystem::exists(directory + "/" + name + ending)) << name << ending;
    EXPECT_TRUE(contains(page, std::string("<figure id='") + name + "'")) << name;
  }
  // Nothing is fetched from anywhere.
  for (const char* part : {"http://", "https://", "<script", "<link", "@import"})
    EXPECT_FALSE(contains(page, part)) << part;
  // It is for others too: no folder of this machine.
  for (const std::string& part :
       std::vector<std::string>{"/tmp/", HAMGEN_SOURCE_DIR, scratch.path("")})
    EXPECT_FALSE(contains(page, part)) << part;
  // Every picture has a form for dark paper, and every script draws into the folder it is in.
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const std::string path = entry.path().string();
    if (entry.path().extension() == ".svg") {
      EXPECT_TRUE(contains(read(path), "prefers-color-scheme: dark")) << path;
    }
    if (entry.path().extension() == ".gp") {
      EXPECT_TRUE(contains(read(path), "set output '" + entry.path().stem().string() + ".svg'"))
          << path;
    }
  }
  const std::filesystem::path drawn = directory + "/portrait.svg";
  const auto size = std::filesystem::file_size(drawn);
  std::filesystem::remove(drawn);
  runtime::ProcessRequest request;
  request.command = {"sh", "-c", "cd \"$0\" && gnuplot portrait.gp", directory};
  ASSERT_TRUE(runtime::run_process(request).succeeded());
  // Without the dark form, which the command puts in.
  EXPECT_GT(std::filesystem::file_size(drawn), size / 2);
}

// A time of the model's own is no axis of space, a run that is shown step by step is so once, and
// the signs between terms have the same room on both sides.
TEST(Report, OfADrivenSystemShowsItsPhasePortraitAndNothingTwice) {
  const Scratch scratch;
  const std::string directory = scratch.path("out");
  ASSERT_EQ(
      hamgen({"report", HAMGEN_SOURCE_DIR "/hamiltonians/driven_oscillator.ham", "-o", directory,
              "--rounds", "1", "--quiet", "--schemes", "implicit-midpoint", "--steps", "300"})
          .status,
      0);
  const std::string page = read(directory + "/report.html");
  EXPECT_TRUE(contains(page, "<figure id='portrait'"));
  EXPECT_TRUE(contains(page, "<figure id='energy'"));
  EXPECT_FALSE(contains(page, "<figure id='orbit'"));
  EXPECT_FALSE(contains(page, "<figure id='energy_zoom'"));
  EXPECT_TRUE(contains(page, "</math><wbr><math displaystyle='true'><mrow><mo form='infix'>"));
  EXPECT_FALSE(contains(page, "</math> <math displaystyle='true'>"));
}

std::string without_pictures(std::string page) {
  for (std::size_t at; (at = page.find("'data:")) != std::string::npos;)
    page.erase(at, page.find('\'', at + 1) + 1 - at);
  return page;
}

// The five lines, then the picture of errors against time, then the rest; tables behind folds.
TEST(Report, AnswersFirst) {
  const Scratch scratch;
  const std::string directory = scratch.path("out");
  const Result result =
      report(scratch.write("m.ham", pendulum), directory, {"--json", "--target", "1e-4"});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string page = read(directory + "/report.html");
  std::size_t before = page.find("<h1>");
  for (const char* part :
       {"<dt>Method</dt>", "<strong>implicit-midpoint</strong>, order 2", "<dt>Conserves</dt>",
        "the symplectic form", "<dt>Reached</dt>", "of its scale",
        "<dt>For a state error 10<sup>−4</sup></dt>", "take <strong>",
        "<code class='command'><span>hamgen</span> <span>run</span> <span>m.ham</span> "
        "<span>--scheme",
        "<span>--h</span>", "<dt>Left out</dt>", "<figure id='bench_state' class='large'>",
        "<h2>The system</h2>", "<h2>What it does</h2>"}) {
    const std::size_t at = page.find(part, before);
    ASSERT_NE(at, std::string::npos) << part;
    before = at;
  }
  for (std::size_t at = page.find("<table"); at != std::string::npos;
       at = page.find("<table", at + 1)) {
    const bool is_small = contains(page.substr(at, 120), "error</th><th>quickest") ||
                          contains(page.substr(at, 120), "terms to");
    const bool is_folded = page.rfind("<details>", at) != std::string::npos &&
                           (page.rfind("</details>", at) == std::string::npos ||
                            page.rfind("</details>", at) < page.rfind("<details>", at));
    EXPECT_TRUE(is_small || is_folded) << page.substr(at, 200);
  }
  // Numbers are written in one way.
  const std::string text =
      page.substr(page.find("<main>"), page.find("<details>") - page.find("<main>"));
  EXPECT_FALSE(std::regex_search(without_pictures(text), std::regex("[0-9]e[-+][0-9]")));
  // The same as values.
  const json values = json::parse(result.out);
  EXPECT_EQ(values["scheme"], "implicit-midpoint");
  EXPECT_EQ(values["order"], 2);
  EXPECT_EQ(values["directory"], directory);
  EXPECT_EQ(values["answers"][0]["target"], 1e-4);
  EXPECT_TRUE(values["answers"][0]["command"].get<std::string>().starts_with("hamgen run "));
  const json& energy = values["reached"]["energy"];
  EXPECT_DOUBLE_EQ(energy["max_relative_error"].get<double>() * energy["scale"].get<double>(),
                   energy["max_error"].get<double>());
  EXPECT_GT(values["reached"]["after"]["q_error"].get<double>(), 0.0);
  EXPECT_EQ(values["figures"][0]["name"], "bench_state");
  bool is_proved = false;
  for (const json& each : values["proof"])
    is_proved = is_proved || (each["property"] == "symplectic" && each["verdict"] == "proved");
  EXPECT_TRUE(is_proved) << values["proof"];
}

TEST(Report, KeepsUserTextOutOfMarkupAndScripts) {
  const Scratch scratch;
  const std::string text =
      "# <script>alert('&')</script>\r\nsystem m\r\n"
      "coordinate q [<b>] # it's `touch touched` \\\r\nmomentum p\r\nH = p^2/2 - cos(q)\r\n"
      "scene s { q = 1; h = 0.1; steps = 100 }\r\n";
  const std::string directory = scratch.path("it's\n`touch touched`\"; \u202E");
  const Result result = report(scratch.write("<i>'\n.ham", text), directory);
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string page = read(directory + "/report.html");
  EXPECT_TRUE(contains(page, "&lt;script&gt;alert(&#39;&amp;&#39;)&lt;/script&gt;</p>")) << page;
  EXPECT_TRUE(contains(page, "<code>&lt;i&gt;&#39;\n.ham</code>"));
  for (const char* part : {"<script", "<b>", "<i>", "\r"})
    EXPECT_FALSE(contains(page, part)) << part;
  for (const char* name : {"/portrait.svg", "/portrait.png"})
    EXPECT_TRUE(std::filesystem::exists(directory + name)) << name;
  EXPECT_FALSE(std::filesystem::exists("touched"));
}

// alpha is a parameter of the step that the model does not have.
TEST(Report, TakesAParameterOfTheScheme) {
  const Scratch scratch;
  const std::string directory = scratch.path("out");
  const Result result =
      report(scratch.write("m.ham", pendulum), directory, {"--alpha", "alpha", "--steps", "100"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(
      read(directory + "/report.html"),
      "<tr><td class='name'><math><mrow><mi>α</mi></mrow></math></td><td class='number'>0.5"
      "</td><td></td><td>of the scheme</td></tr>"));
}

TEST(Report, TakesStepsThatTheSceneDoesNotHaveAndSaysWhereItWasMeasured) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", without_steps);
  const std::string directory = scratch.path("out");
  const Result none = report(model, directory);
  EXPECT_EQ(none.status, 2);
  EXPECT_TRUE(contains(none.err, "--h 0.01")) << none.err;
  const Result half = report(model, directory, {"--h", "0.1"});
  EXPECT_EQ(half.status, 2);
  EXPECT_TRUE(contains(half.err, "--steps 1000")) << half.err;
  const Result result = report(model, directory, {"--h", "0.1", "--steps", "100"});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string page = read(directory + "/report.html");
  for (const char* part :
       {"100 steps of <math><mrow><mi>h</mi><mo>=</mo><mn>0.1</mn></mrow></math>.",
        "Every method to <math><mrow><mi>t</mi><mo>=</mo><mn>10</mn></mrow></math>,", " threads",
        "-O3", "<dt>date</dt>", ">±</th>", " %</td>"})
    EXPECT_TRUE(contains(page, part)) << part;
}

// The attribute's value of a page inside a frame.
std::string as_attribute(const std::string& page) {
  std::string text;
  for (const char c : page) {
    if (c == '&') {
      text += "&amp;";
    } else if (c == '"') {
      text += "&quot;";
    } else {
      text += c;
    }
  }
  return text;
}

// A page with the report in three frames, as wide as a telephone, a tablet and a screen, that says
// what it sees of each: width of the contents, pictures, how many of those are drawn and how many
// letters they have as large as they must be, the font of formulas, the smallest text, how light
// paper and ink are, and how much of each picture is lighter than half.
std::string probe_page(const std::string& page) {
  std::string text = "<!DOCTYPE html><meta charset='utf-8'><body>\n";
  for (const char* width : {"390", "820", "1400"})
    text += std::string("<iframe style='border:0' width='") + width + "' height='900' srcdoc=\"" +
            as_attribute(page) + "\"></iframe>\n";
  return text + R"(<pre id='seen'></pre><script>
const drawnWidth = image => Number(atob(image.currentSrc.split(',')[1]).match(/viewBox="0 0 ([0-9]+)/)[1]);
const light = colour => colour.match(/[0-9.]+/g).slice(0, 3).reduce((sum, c) => sum + Number(c), 0) / 765;
const lightPart = image => {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 100;
  const paper = canvas.getContext('2d');
  paper.drawImage(image, 0, 0, 100, 100);
  const bytes = paper.getImageData(0, 0, 100, 100).data;
  let count = 0;
  for (let i = 0; i < bytes.length; i += 4)
    if (bytes[i + 3] > 128 && bytes[i] + bytes[i + 1] + bytes[i + 2] > 384) ++count;
  return count / 10000;
};
window.addEventListener('load', async () => {
  const seen = [];
  for (const frame of document.querySelectorAll('iframe')) {
    const page = frame.contentDocument;
    await page.fonts.ready;
    const images = [...page.images];
    const text = [...page.querySelectorAll('p, td, th, li, dt, dd, figcaption, pre')];
    const boxes = [...page.querySelectorAll('main, figure, dl, h1, h2')];
    const style = frame.contentWindow.getComputedStyle(page.body);
    seen.push({width: frame.clientWidth, contents: page.documentElement.scrollWidth,
      outside: boxes.filter(b => b.getBoundingClientRect().right > frame.clientWidth).length,
      pictures: images.length,
      drawn: images.filter(i => i.complete && i.naturalWidth > 0 && i.clientWidth > 200).length,
      shrunk: images.map(i => [i.clientWidth, drawnWidth(i)]).filter(([shown, drawn]) => shown < 0.74 * drawn),
      formulas: page.querySelectorAll('math').length,
      font: [...page.fonts].filter(f => f.family == 'Formula' && f.status == 'loaded').length,
      open: page.querySelectorAll('details[open]').length,
      paper: light(style.backgroundColor), ink: light(style.color),
      lightest: Math.max(...images.map(lightPart)),
      smallest: Math.min(...text.map(e => parseFloat(frame.contentWindow.getComputedStyle(e).fontSize)))});
  }
  document.getElementById('seen').textContent = JSON.stringify(seen);
});</script>)";
}

// What the probe says in a browser that likes its pages dark, or light.
json seen_in_browser(const Scratch& scratch, const std::string& probe, bool dark) {
  // As root and in a container there is neither a sandbox nor much shared memory.
  runtime::ProcessRequest request;
  request.command = {"chromium",
                     "--headless",
                     "--no-sandbox",
                     "--disable-gpu",
                     "--disable-dev-shm-usage",
                     std::string("--blink-settings=preferredColorScheme=") + (dark ? "0" : "1"),
                     "--user-data-dir=" + scratch.path(dark ? "dark" : "light"),
                     "--enable-logging=stderr",
                     "--virtual-time-budget=20000",
                     "--dump-dom",
                     "file://" + probe};
  request.output_limit = 64u << 20;
  request.time_limit = std::chrono::minutes(20);
  runtime::ProcessResult result;
  try {
    result = runtime::run_process(request);
  } catch (const runtime::ToolError&) {
    ADD_FAILURE() << "chromium is not there, so the page was not opened in a browser; "
                     "scripts/install-dependencies full installs it";
    return json::array();
  }
  EXPECT_TRUE(result.succeeded()) << runtime::end_text(result, request);
  EXPECT_FALSE(contains(result.output, "CONSOLE")) << "the browser's console has messages";
  const std::string mark = "<pre id=\"seen\">";
  const std::size_t begin = result.output.rfind(mark);
  if (begin == std::string::npos) return json::array();
  const std::size_t first = begin + mark.size();
  return json::parse(result.output.substr(first, result.output.find("</pre>", first) - first));
}

TEST(Report, ShowsInABrowserWideAndNarrowLightAndDark) {
  const Scratch scratch;
  // Two degrees of freedom with the longest formulas, verdicts and tables.
  const std::string directory = scratch.path("out");
  ASSERT_EQ(report(HAMGEN_SOURCE_DIR "/hamiltonians/kepler.ham", directory).status, 0);
  const std::string probe =
      scratch.write("probe.html", probe_page(read(directory + "/report.html")));
  for (const bool dark : {false, true}) {
    const json seen = seen_in_browser(scratch, probe, dark);
    ASSERT_EQ(seen.size(), 3u);
    for (const json& frame : seen) {
      EXPECT_LE(frame["contents"].get<int>(), frame["width"].get<int>()) << frame;
      EXPECT_GE(frame["pictures"].get<int>(), 6) << frame;
      EXPECT_EQ(frame["drawn"], frame["pictures"]) << frame;
      EXPECT_EQ(frame["outside"], 0) << frame;
      EXPECT_TRUE(frame["shrunk"].empty()) << frame;  // letters of 15 pixels stay above 11
      EXPECT_EQ(frame["font"], 1) << "the font of formulas is not there: " << frame;
      EXPECT_EQ(frame["open"], 0) << frame;
      EXPECT_GE(frame["formulas"].get<int>(), 5) << frame;
      EXPECT_GE(frame["smallest"].get<double>(), 12.0) << frame;
      const double paper = frame["paper"];
      const double ink = frame["ink"];
      EXPECT_EQ(paper < 0.2, dark) << frame;
      EXPECT_GT(std::fabs(paper - ink), 0.6) << frame;
      // Of a picture on dark paper lines and letters are light, and no box.
      if (dark) {
        EXPECT_LT(frame["lightest"].get<double>(), 0.3) << frame;
      }
    }
  }
}

}  // namespace
}  // namespace hamgen::app_test
