#include "scenarios/detect.h"
#include "scenarios/svg_panel.h"

namespace piperun::scenarios {
namespace {

constexpr double kWidth = 1000, kPanel = 200, kLeft = 70, kRight = 20, kTop = 40, kGap = 50;

}  // namespace

std::string DrawDetectionsSvg(const Detections& detections) {
  std::vector<double> places, band_dB, ratio_dB;
  for (const DetectedLevel& level : detections.levels) {
    places.push_back(detections.placed ? level.chainage_m : level.time_s);
    band_dB.push_back(level.band_dB);
    ratio_dB.push_back(level.ratio_dB);
  }
  const SvgAxis x = MakeSvgAxis(places, kLeft, kWidth - kRight);
  const std::string along = detections.placed ? "chainage, m" : "time, s";
  std::string content;
  double top = kTop;
  for (const auto& [title, levels] : {std::pair{"band 1-4 kHz, dB re 1 uPa", &band_dB},
                                      std::pair{"band over 200-1000 Hz, dB", &ratio_dB}}) {
    const SvgAxis y = MakeSvgAxis(*levels, top + kPanel, top);
    content += DrawSvgGrid(x, y) + DrawSvgCurve(x, y, places, *levels);
    content += DrawSvgText(kLeft, top - 8, std::string(title) + " against " + along, "font-size=\"13\"");
    for (const estimator::LeakEstimate& leak : detections.leaks)
      content += DrawSvgMark(x.At(detections.placed ? leak.chainage_m : Seconds(leak.t_cpa)), y);
    top += kPanel + kGap;
  }
  return DrawSvg(kWidth, top, content);
}

}  // namespace piperun::scenarios
