// Bridge devices over all kinds of lines, in real time: a child program, sockets, a
// pseudo-terminal, and their faults. With PALPATE_FAULT_TABLE=1 every fault is tested on
// every line.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>

#include "devices/bridge/bridge_bus.h"
#include "tests/support/bridge_session.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::ChildProcess;
using test::open_bridge;
using test::SpringSession;

const std::string kPeer = std::string(PALPATE_SOURCE_DIR) + "/tests/devices/bridge/peer.py";

bool everything() { return std::getenv("PALPATE_FAULT_TABLE") != nullptr; }

struct Fault {
  const char* mode;      // of peer.py
  std::uint32_t faults;  // at least one of these must occur
};

std::vector<Fault> faults() {
  using namespace device_fault;
  return {{"silent", kLate},
          {"die", kUnplugged},
          {"corrupt", kCorrupt},
          {"cut", kCorrupt},
          {"text", kCorrupt | kLate},
          {"reordered", kOutOfOrder},
          {"repeated", kLate},
          {"late", kLate},
          {"jump", kJump},
          {"nan", kCorrupt},
          {"version", kWrongFirmware},
          {"own", kOwn},
          {"deaf", kWriteStalled}};
}

// The device's end of a line and the target to open. For `exec` open_bridge starts the peer.
class Line {
 public:
  Line(const std::string& kind, const test::TemporaryFolder& folder, const std::string& mode) {
    const std::string log = folder.file("log");
    std::filesystem::remove(log);
    const std::string place = kind == "tcp" ? std::to_string(20000 + getpid() % 20000) : folder.file(kind);
    const std::string command = "python3 " + kPeer + " " + mode + " 0.3 " + log;
    if (kind == "exec") {
      target_ = "exec:" + command;
      return;
    }
    std::filesystem::remove(place);
    peer_ = std::make_unique<ChildProcess>(std::vector<std::string>{"python3", kPeer, mode, "0.3", log, kind, place});
    target_ = kind == "pty" ? place : kind == "unix" ? "unix:" + place : "tcp:127.0.0.1:" + place;
    if (kind != "tcp") test::wait_for([&] { return std::filesystem::exists(place); });
  }
  Result<std::unique_ptr<Device>> open() const {
    Result<std::unique_ptr<Device>> device = open_bridge(target_);
    // A socket's file exists shortly before the socket listens.
    test::wait_for([&] { return device.ok() || (device = open_bridge(target_)).ok(); }, 5);
    return device;
  }

 private:
  std::unique_ptr<ChildProcess> peer_;
  std::string target_;
};

double logged_s(const std::string& path, const std::string& word) {
  std::ifstream file(path);
  std::string name;
  for (double at_s = 0.0; file >> name >> at_s;) {
    if (name == word) return at_s;
  }
  return 0.0;
}

struct Outcome {
  bool pushed = false;
  double to_zero_ms = -1.0;        // until the loop renders 0
  double to_zero_there_ms = -1.0;  // until the device receives 0
  std::uint32_t faults = 0;
};

Outcome run(const std::string& kind, const char* mode) {
  const test::TemporaryFolder folder;
  const Line line(kind, folder, mode);
  auto device = line.open();
  EXPECT_TRUE(device.ok()) << (device ? "" : device.error().message);
  Outcome outcome;
  if (!device) return outcome;
  SpringSession session(std::move(*device));
  std::vector<LoopSnapshot> all;
  test::wait_for(
      [&] {
        for (const LoopSnapshot& one : session.snapshots()) all.push_back(one);
        const double event_s = logged_s(folder.file("log"), "event");
        return event_s > 0.0 && steady_now_s() > event_s + 0.4;
      },
      10);
  const double event_s = logged_s(folder.file("log"), "event");
  for (const LoopSnapshot& one : all) {
    if (one.loop_time_s <= event_s) outcome.pushed = one.rendered_N > 1.5;
    if (one.loop_time_s > event_s && event_s > 0.0) {
      outcome.faults |= one.device.faults;
      if (one.rendered_N == 0.0 && outcome.to_zero_ms < 0.0) outcome.to_zero_ms = 1e3 * (one.loop_time_s - event_s);
    }
  }
  const double zero_s = logged_s(folder.file("log"), "zero");
  if (zero_s > 0.0) outcome.to_zero_there_ms = 1e3 * (zero_s - event_s);
  return outcome;
}

void expect_faults_stop_the_force(const std::string& kind, const std::vector<Fault>& list) {
  for (const Fault& fault : list) {
    Outcome outcome = run(kind, fault.mode);
    // On a busy machine another fault may have set the force to zero before the event.
    for (int more = 0; more < 3 && !outcome.pushed; ++more) outcome = run(kind, fault.mode);
    std::printf("%-5s %-10s  rendered 0 after %6.1f ms", kind.c_str(), fault.mode, outcome.to_zero_ms);
    if (outcome.to_zero_there_ms >= 0.0) std::printf(", heard after %6.1f ms", outcome.to_zero_there_ms);
    const auto words = device_fault_words(outcome.faults & fault.faults);
    std::printf("  %s\n", words.empty() ? "" : words.front().c_str());
    EXPECT_TRUE(outcome.pushed) << kind << " " << fault.mode;
    EXPECT_GE(outcome.to_zero_ms, 0.0) << kind << " " << fault.mode;
    EXPECT_NE(outcome.faults & fault.faults, 0u) << kind << " " << fault.mode << " " << outcome.faults;
  }
}

int thread_count() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    int count = 0;
    if (word == "Threads:" && status >> count) return count;
  }
  return -1;
}

TEST(BridgeLines, EveryFaultOfAChildProgramTakesTheForceAway) {
  const int threads = thread_count();
  expect_faults_stop_the_force("exec", faults());
  EXPECT_TRUE(test::wait_for([&] { return thread_count() <= threads; }))
      << thread_count() << " threads, " << threads << " before";
}

TEST(BridgeLines, FaultsOfSocketsAndSerialLinesTakeTheForceAway) {
  std::vector<Fault> list = faults();
  if (!everything()) list.resize(2);
  for (const char* kind : {"unix", "tcp", "pty"}) {
    expect_faults_stop_the_force(kind, list);
  }
}

TEST(BridgeLines, APortThatVanishesAndReturnsIsUsedAgain) {
  const test::TemporaryFolder folder;
  auto line = std::make_unique<Line>("unix", folder, "die");
  Result device = test::must(line->open());
  SpringSession session(std::move(*device));
  ASSERT_TRUE(test::wait_for([&] { return (session.loop().newest().device.faults & device_fault::kUnplugged) != 0; }));
  line.reset();
  line = std::make_unique<Line>("unix", folder, "none");
  EXPECT_TRUE(test::wait_for([&] { return session.loop().newest().rendered_N > 2.0; })) << "with its ramp";
  EXPECT_EQ(session.loop().newest().device.faults, 0u);
}

TEST(BridgeLines, AChildProgramEndsWithItsDevice) {
  const test::TemporaryFolder folder;
  const Line line("exec", folder, "none");
  const auto running = [log = folder.file("log")] {
    for (const auto& process : std::filesystem::directory_iterator("/proc")) {
      std::ifstream file(process.path() / "cmdline");
      const std::string words((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
      if (words.find(log) != std::string::npos) return true;
    }
    return false;
  };
  {
    Result device = test::must(line.open());
    EXPECT_TRUE(running());
  }
  EXPECT_FALSE(running());
}

// The example program, 3 mm inside, which logs each force that it applies, and "end" when it ends by itself. `start`:
// its first statements.
std::string logging_program(const test::TemporaryFolder& folder, const std::string& start = "") {
  std::string text = test::read_text(std::string(PALPATE_SOURCE_DIR) + "/assets/examples/bridge/bridge.py");
  const auto put = [&](const std::string& old, const std::string& next) {
    const std::size_t at = text.find(old);
    ASSERT_NE(at, std::string::npos) << old;
    text.replace(at, old.size(), next);
  };
  put("RATE_HZ = 1000", "RATE_HZ = 1000\nLOG = open(\"" + folder.file("log") + "\", \"a\", buffering=1)\n" + start);
  put("return position_m, 400", "return 0.003, 400");
  put("limit it here as well to the rated force of your motor.\"\"\"",
      "limit it.\"\"\"\n    LOG.write(\"%.3f\\n\" % force_N)");
  put("finally:\n    apply_force(0.0)", "finally:\n    apply_force(0.0)\n    LOG.write(\"end\\n\")");
  return folder.with_file("logging.py", text);
}

TEST(BridgeLines, AProgramAppliesTheLastForceOf0BeforeItIsEnded) {
  for (const char* start : {"",  // and one that ends once and is started again, by another thread
                            "if not os.path.exists(__file__ + \"2\"):\n    open(__file__ + \"2\", \"w\")\n"
                            "    import threading\n    threading.Timer(1.0, os._exit, [3]).start()\n"}) {
    SCOPED_TRACE(start);
    const test::TemporaryFolder folder;
    const std::string program = logging_program(folder, start);
    Result device = test::must(open_bridge("exec:python3 " + program));
    {
      SpringSession session(std::move(*device));
      ASSERT_TRUE(test::wait_for([&] { return session.loop().newest().rendered_N > 2.0; }));
      if (*start != '\0') {
        ASSERT_TRUE(
            test::wait_for([&] { return (session.loop().newest().device.faults & device_fault::kUnplugged) != 0; }));
        ASSERT_TRUE(test::wait_for([&] { return session.loop().newest().rendered_N > 2.0; }));
      }
    }
    const std::string log = test::read_text(folder.file("log"));
    EXPECT_EQ(log.substr(log.size() - 16), "0.000\n0.000\nend\n");
  }
}

TEST(BridgeLines, AProgramThatIgnoresTheEndOfItsInputIsStillEnded) {
  const test::TemporaryFolder folder;
  const std::string program = logging_program(folder,
                                              "signal = __import__(\"signal\")\n"
                                              "signal.signal(signal.SIGTERM, signal.SIG_IGN)\n");
  std::string text = test::read_text(program);
  text.replace(text.find("                return\n"), 23, "                break\n");
  folder.with_file("logging.py", text);
  Result device = test::must(open_bridge("exec:python3 " + program));
  const double start_s = steady_now_s();
  device->reset();
  EXPECT_LT(steady_now_s() - start_s, 3.0);
}

TEST(BridgeLines, FewerThanOneHundredSamplesASecondAreRefusedAtTheStart) {
  const test::TemporaryFolder folder;
  const std::string text = test::read_text(std::string(PALPATE_SOURCE_DIR) + "/assets/examples/bridge/bridge.py");
  for (const auto& [rate_Hz, words] :
       {std::pair{"9", "sends 9 samples"}, {"30", "sends 30 samples"}, {"80", "sends "}}) {
    std::string slow = text;
    slow.replace(slow.find("RATE_HZ = 1000"), 14, std::string("RATE_HZ = ") + rate_Hz);
    const auto device = open_bridge("exec:python3 " + folder.with_file("slow.py", slow));
    ASSERT_FALSE(device.ok()) << rate_Hz;
    EXPECT_TRUE(test::has_parts(device.error().message,
                                {words, " a second, expected 100 to 10000; raise the rate of the device's program"}));
  }
}

TEST(BridgeLines, AWrongClockSequenceOrRateIsRefusedAtTheStart) {
  const test::TemporaryFolder folder;
  for (const auto& [mode, words] : {std::pair{"clock-s", "expected microseconds in bytes 8 to 11"},
                                    {"clock-ms", "expected microseconds in bytes 8 to 11; it seems to count ms"},
                                    {"clock-ns", "expected microseconds in bytes 8 to 11; it seems to count ns"},
                                    {"clock-0", "expected microseconds in bytes 8 to 11; it stands still"},
                                    {"uncounted", "does not increase by 1 with each; count them in bytes 4 to 7"},
                                    {"fast", " samples a second, expected 100 to 10000; lower the rate"}}) {
    const auto device = open_bridge("exec:python3 " + kPeer + " " + mode + " 9 " + folder.file("log"));
    ASSERT_FALSE(device.ok()) << mode;
    EXPECT_TRUE(test::has_parts(device.error().message, {words})) << mode;
  }
}

TEST(BridgeLines, ErrorsHaveReasonAndAdvice) {
  const auto complaint = [](const std::string& target) {
    const auto device = open_bridge(target);
    return device ? "opened" : device.error().message;
  };
  EXPECT_TRUE(test::has_parts(complaint("exec:echo Traceback"), {"exit code 0", "\"Traceback \"", "; "}));
  EXPECT_TRUE(test::has_parts(complaint("exec:exit 3"), {"exit code 3", "; "}));
  EXPECT_TRUE(test::has_parts(complaint("exec:cd / && exit 4"), {"exit code 4", "; "}));
  EXPECT_TRUE(test::has_parts(complaint("unix:/nowhere/at/all"), {"/nowhere/at/all", "; "}));
  EXPECT_TRUE(test::has_parts(complaint("/dev/null"), {"/dev/null: ", "serial line; "}));
  EXPECT_TRUE(test::has_parts(complaint("/dev/nowhere"), {"/dev/nowhere: No such file or directory; ", "/dev/tty*"}));
  EXPECT_TRUE(test::has_parts(complaint("/dev/tty,300"), {"/dev/tty,300:", "115200", "2000000"}));
  EXPECT_TRUE(test::has_parts(complaint("tcp:192.0.2.1:5000"), {"192.0.2.1:5000:", "another computer"}));
  EXPECT_TRUE(test::has_parts(complaint("tcp:127.0.0.1:0"), {"--device", "127.0.0.1:0:", "HOST", "PORT",
                                                             "from 1 to 65535", "devices/README.md#bridge"}));
  EXPECT_TRUE(test::has_parts(complaint("somewhere"), {"--device", "/dev/TTY", "BAUD", "PATH", "HOST", "PORT",
                                                       "COMMAND", "devices/README.md#bridge"}));
  EXPECT_TRUE(test::has_parts(complaint("remote-tcp:192.0.2.1:5000"), {"expected /dev/TTY"}));
  EXPECT_TRUE(test::has_parts(complaint("unix:/nowhere/\x1b[31m"), {"/nowhere/\\x1b[31m:"}));
}

}  // namespace
}  // namespace palpate
