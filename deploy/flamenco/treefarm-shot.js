// SPDX-License-Identifier: Apache-2.0
// A shot as a job type of Flamenco 3: a task for each frame. Goes into the manager's folder `scripts`; workers need the program in their
// PATH, or a variable {treefarm} of the manager, and the folder of the results. A task that is tried again goes on from its checkpoint.

const JOB_TYPE = {
    label: "Treefarm Shot",
    settings: [
        { key: "scene", type: "string", required: true, description: "Mitsuba scene (.xml) or job (.toml)" },
        { key: "frames", type: "string", required: true, default: "1-24",
          description: "Frames to render. Examples: '47', '1-30', '3, 5-10, 47-327'" },
        { key: "folder", type: "string", subtype: "dir_path", required: true,
          description: "Where results go: a folder for each frame" },
        { key: "options", type: "string", default: "-D frame=%d --error 5%",
          description: "What treefarm render takes besides; %d, %04d, and #### in the name of -o, are the frame's number" },
        { key: "program", type: "string", default: "treefarm", visible: "submission", description: "Of the workers" },
        { key: "threads", type: "int32", default: 0, propargs: { min: 0, max: 1024 }, visible: "submission",
          description: "Threads of a frame; 0: a worker's processors" },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    const options = settings.options.split(" ").filter((word) => word !== "");
    for (const frame of frameChunker(settings.frames, 1)) {
        const digits = String(frame).padStart(4, "0");
        const of_frame = (word) => word.replace(/%04d/g, digits).replace(/%d/g, frame);
        const of_output = (word) => word.replace(/#+(?=[^/]*$)/g, (run) => String(frame).padStart(run.length, "0"));
        const is_output = (i) => ["-o", "--output"].includes(options[i - 1]) || options[i].startsWith("--output=");
        const arguments_of = (word, i) => of_frame(is_output(i) ? of_output(word) : word);
        const words = ["launch", "--", "render", of_frame(settings.scene)].concat(options.map(arguments_of));
        words.push("--run-dir", path.join(settings.folder, `frame.${digits}`), "--resume");
        if (settings.threads > 0) words.push("--threads", String(settings.threads));
        const task = author.Task(`frame-${digits}`, "misc");
        task.addCommand(author.Command("exec", { exe: settings.program, args: words }));
        job.addTask(task);
    }
}
