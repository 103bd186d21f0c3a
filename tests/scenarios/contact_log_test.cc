#include "scenarios/contact_log.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/scenarios/small_scenario.h"
#include "tests/support/pipes.h"

namespace piperun::scenarios {
namespace {

const std::string kHeader =
    "#timestamp [ns],duration [s],pipe,s [m],chainage [m],p_W_x [m],p_W_y [m],p_W_z [m],"
    "impulse_W_x [N s],impulse_W_y [N s],impulse_W_z [N s],closing_speed [m s^-1],peak_force [N],feature\n";

sim::ContactEvent MakeEvent(int begin_ms, int feature = -1, double impulse_N_s = 0.5) {
  sim::ContactEvent event;
  event.begin = TrueTime(std::chrono::milliseconds(begin_ms));
  event.duration_s = 0.002;
  event.pipe = 0;
  event.s_m = 1.5;
  event.chainage_m = 3;
  event.p_W = {1, -2, 0.25};
  event.impulse_W_N_s = {0, impulse_N_s, 0};
  event.closing_speed_m_s = 0.125;
  event.peak_force_N = 250;
  event.feature = feature;
  return event;
}

class ContactLogTest : public ::testing::Test {
 protected:
  ContactLogTest()
      : network_(piperun::testing::MakeLineNetwork({{0, 0, 0}, {6, 0, 0}})),
        log_(folder_ / "contacts.csv", network_, {"J1", "J2"}) {}
  std::string Text() const { return FileText(folder_ / "contacts.csv"); }

  TemporaryFolder folder_;
  Network network_;
  ContactLog log_;
};

TEST_F(ContactLogTest, HasTheDocumentedColumns) {
  log_.Add(MakeEvent(7, 1));
  log_.Close();
  EXPECT_EQ(Text(), kHeader + "7000000,0.002,P,1.5,3,1,-2,0.25,0,0.5,0,0.125,250,J2\n");
}

TEST_F(ContactLogTest, NamesFeaturesByTheirIds) {
  for (const int feature : {-1, 0, 5}) log_.Add(MakeEvent(10 + feature, feature));
  log_.Close();
  const std::string text = Text();
  for (const char* end : {"250,wall\n", "250,J1\n", "250,5\n"}) {
    EXPECT_NE(text.find(end), std::string::npos) << end;
  }
}

TEST_F(ContactLogTest, WritesByTheirBeginningsWhatIsToldByTheirEnds) {
  // each is told within 100 ms of its beginning
  struct Told {
    int begin_ms, now_ms;
  };
  for (const Told& told : {Told{20, 25}, Told{15, 40}, Told{0, 100}, Told{90, 101}, Told{80, 180}}) {
    log_.Add(MakeEvent(told.begin_ms));
    log_.WriteUntil(TrueTime(std::chrono::milliseconds(told.now_ms)));
  }
  log_.Close();
  std::string stamps;
  const std::string text = Text();
  for (std::size_t i = text.find('\n') + 1; i < text.size(); i = text.find('\n', i) + 1) {
    stamps += text.substr(i, text.find(',', i) - i) + " ";
  }
  EXPECT_EQ(stamps, "0 15000000 20000000 80000000 90000000 ");
}

TEST_F(ContactLogTest, SumsUpWhatItWrote) {
  log_.Add(MakeEvent(1, -1, 0.25));
  log_.Add(MakeEvent(2, -1, -0.75));
  log_.Add(MakeEvent(3, -1, 0.5));
  log_.Close();
  EXPECT_EQ(log_.summary().count, 3);
  EXPECT_EQ(log_.summary().largest_impulse_N_s, 0.75);
}

}  // namespace
}  // namespace piperun::scenarios
