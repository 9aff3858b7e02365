//! The tools for debugging name the pass and the pixel of a defect. `SHADOWGRAPH_SOAK` is the number of frames without a defect, a tenth of
//! them is drawn with one, `SHADOWGRAPH_SOAK_SEED` the seed.

use std::ops::ControlFlow;

use shadowgraph::Gpu;
use shadowgraph::core::{Graph, ValueCheck, ValueReport};
use shadowgraph::inspect::{ContentsRecorder, Dump, Tolerance};
use shadowgraph_tests::planted::{Defect, Planted, RandomFrame, Shaders};
use shadowgraph_tests::random::Random;

use crate::stage::gpu;

/// Frames without a defect, if `SHADOWGRAPH_SOAK` is not set.
const FRAMES: u32 = 40;

pub(crate) fn from_env(name: &str, default: u32) -> u32 {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
}

/// Draws a frame, and returns its dump with values.
fn record(gpu: &Gpu, shaders: &Shaders, frame: &RandomFrame, planted: Option<Planted>) -> Dump {
    let mut graph = Graph::new();
    let mut declared = graph.frame();
    let output = frame.declare(&mut declared, shaders, planted);
    declared.export_texture(&output);
    let mut recorder = ContentsRecorder::new(64 << 20);
    let compiled = graph.compile(declared).unwrap();
    let mut add = |contained| {
        recorder.add(&contained);
        ControlFlow::Continue(())
    };
    let executed = compiled.execute_visited(&mut graph, &gpu.device, &gpu.queue, &mut add).unwrap();
    let dump = Dump::from_json(&recorder.dump(executed.plan()).unwrap()).unwrap();
    dump.with_values(recorder.into_values()).unwrap()
}

/// Draws a frame with a check of values, and returns the name of the first pass with bad values, and the report.
fn check(
    gpu: &Gpu,
    shaders: &Shaders,
    frame: &RandomFrame,
    planted: Option<Planted>,
) -> (Option<String>, ValueReport) {
    let mut graph = Graph::new();
    graph.check_values(Some(ValueCheck::default()));
    let mut declared = graph.frame();
    let output = frame.declare(&mut declared, shaders, planted);
    declared.export_texture(&output);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut executed =
        graph.compile(declared).unwrap().execute(&mut graph, &gpu.device, &mut encoder).unwrap();
    gpu.queue.submit([encoder.finish()]);
    let report = executed.take_values().unwrap().wait(&gpu.device).unwrap();
    let pass = report.bad.first().map(|bad| executed.plan().pass_path(bad.pass));
    (pass, report)
}

#[test]
fn planted_defects_are_found_and_sound_frames_raise_no_alarm() {
    let Some(gpu) = gpu() else { return };
    let shaders = Shaders::new(&gpu.device);
    let (frames, seed) = (from_env("SHADOWGRAPH_SOAK", FRAMES), from_env("SHADOWGRAPH_SOAK_SEED", 0));
    let mut random = Random::new(seed);
    let mut found = [0; 5];
    for number in 0..frames {
        let frame = RandomFrame::new(&mut random);
        let sound = record(gpu, &shaders, &frame, None);
        let again =
            record(gpu, &shaders, &frame, None).diff_with_contents(&sound, Tolerance::default()).unwrap();
        assert!(again.is_empty(), "seed {seed}, frame {number}: {}", again.to_text());
        let (_, report) = check(gpu, &shaders, &frame, None);
        assert!(report.bad.is_empty(), "seed {seed}, frame {number}: {report:?}");
        if number % 10 >= 5 && frames > FRAMES {
            continue;
        }
        let defect = Defect::ALL[number as usize % 5];
        // Some defects have no effect, such as a stale copy of zeros in place of zeros.
        let planted = (0..20).find_map(|_| {
            let planted = frame.plant(defect, &mut random)?;
            let defective = record(gpu, &shaders, &frame, Some(planted));
            let diff = sound.diff_with_contents(&defective, Tolerance::default()).unwrap();
            Some((planted, diff.contents.unwrap().first?))
        });
        let Some((planted, first)) = planted else { continue };
        let name = format!("pass {}", planted.pass);
        assert_eq!(first.pass.as_ref(), Some(&name), "seed {seed}, frame {number}: {planted:?}, {first:?}");
        assert!(first.from_equal_inputs, "{first:?}");
        let largest = first.largest.as_ref().unwrap();
        assert_ne!(largest.before, largest.after);
        if defect == Defect::Nan {
            let (pass, report) = check(gpu, &shaders, &frame, Some(planted));
            assert_eq!(pass.as_ref(), Some(&name), "seed {seed}, frame {number}: {planted:?}");
            let [x, y] = planted.texel;
            assert_eq!(report.bad[0].first.at, [x, y, 0]);
            assert_eq!(largest.at, [u64::from(x), u64::from(y), 0]);
        }
        found[number as usize % 5] += 1;
    }
    println!("seed {seed}: {frames} sound frames without an alarm; found of each defect {found:?}");
    assert!(found.iter().all(|&count| count > 0), "{found:?}");
}
