#include "scenarios/seal.h"

#include "scenarios/output_file.h"
#include "scenarios/run_json.h"

namespace piperun::scenarios {

void Seal(RunFolder& folder, WallTime begin, RunResult& result) {
  result.file_hashes = HashFiles(folder.staging());
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result.json = WriteRunJson(result);
  WriteTextFile(folder.staging() / "run.json", result.json);
  folder.Commit();
}

}  // namespace piperun::scenarios
