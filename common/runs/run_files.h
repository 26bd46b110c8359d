// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace treefarm {

/// A file or folder of a run directory.
struct RunFile {
    const char* name;
    const char* meaning;
};

inline constexpr const char* kStatusFile = "status.json";
inline constexpr const char* kSummaryFile = "summary.json";
inline constexpr const char* kJobFile = "job.toml";
inline constexpr const char* kResolvedFile = "resolved.toml";
inline constexpr const char* kPlanTextFile = "plan.txt";
inline constexpr const char* kPlanFile = "plan.json";
inline constexpr const char* kLogFile = "log.txt";
inline constexpr const char* kPassesFile = "passes.csv";
inline constexpr const char* kScheduleFile = "schedule.toml";
inline constexpr const char* kImageFile = "image.exr";
inline constexpr const char* kPreviewFile = "preview.png";
inline constexpr const char* kTreeFile = "tree.bin";
inline constexpr const char* kTicketFileName = "join";
inline constexpr const char* kCheckpointFolder = "checkpoint";
inline constexpr const char* kLaunchFolder = "launch";
inline constexpr const char* kInspectFolder = "inspect";
inline constexpr const char* kLockFileName = "lock";

/// Files that a render writes to its run directory. The first two mark a folder as a run directory.
inline constexpr std::array<RunFile, 13> kRunFiles = {{
    {kStatusFile, "progress, once a second, and which process on which host writes it"},
    {kSummaryFile, "how the run ended, where and when it ran, hashes, and the main figures of each pass"},
    {kJobFile, "every setting but output.directory and output.file"},
    {kResolvedFile, "the job as it was used, the tuned constants, and the scene and program it belongs to"},
    {kPlanTextFile, "what was simulated, why, and its expected cost, for people"},
    {kPlanFile, "the same for programs"},
    {kLogFile, "messages, every figure of each pass, and each decision with its reason"},
    {kPassesFile, "the figures of each pass, one line per pass"},
    {kScheduleFile, "the passes as they were chosen, for --schedule"},
    {kImageFile, "the image of the finished passes, with variance, halves and the layers asked for"},
    {kPreviewFile, "the image so far, tiles of the unfinished pass included"},
    {kTreeFile, "the last guiding tree, encoded, for treefarm inspect"},
    {kTicketFileName, "address and secret with which workers join; there while the run takes workers in"},
}};

/// Folders and files of other parts of the program in a run directory.
inline constexpr std::array<RunFile, 4> kRunFolders = {{
    {kCheckpointFolder, "the state from which treefarm resume goes on"},
    {kLaunchFolder, "the log of treefarm launch, and the coordinator's sign of life"},
    {kInspectFolder, "pictures that treefarm inspect draws of the guiding tree"},
    {kLockFileName, "locked while a program works in the folder, where folders cannot be locked"},
}};

// Files of a folder with several runs.
inline constexpr const char* kStudyFile = "study.json";
inline constexpr const char* kCellsFolder = "cells";
inline constexpr const char* kCellFile = "cell.json";
inline constexpr const char* kShotFile = "shot.json";

}  // namespace treefarm
