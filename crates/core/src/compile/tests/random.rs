//! Random frames, checked by the oracle.

use super::counts::Counts;
use super::frame_check::{check_frame, shuffled};
use super::frames::{
    INVALID_CHANGES, Source, Spec, frame_from_bytes, random_calls_from_bytes, small_frame_from_bytes,
};
use super::print;
use crate::{Error, Frame, Graph, Plan};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestCaseError, TestError, TestRunner};
use std::cell::Cell;

/// Runs as many cases on up to `length` bytes, always the same ones unless `PROPTEST_RNG_SEED` says otherwise.
fn run(cases: u32, length: usize, test: impl Fn(&[u8]) -> Result<(), TestCaseError>) {
    let default = Config::default();
    let rng_seed = match default.rng_seed {
        RngSeed::Random => RngSeed::Fixed(1),
        fixed => fixed,
    };
    let config = Config { cases, rng_seed, failure_persistence: None, ..default };
    let bytes = proptest::collection::vec(any::<u8>(), 32..length);
    match TestRunner::new(config).run(&bytes, |bytes| test(&bytes)) {
        Ok(()) => {}
        Err(TestError::Fail(reason, bytes)) => panic!("{reason}\nfrom the bytes {bytes:?}"),
        Err(TestError::Abort(reason)) => panic!("{reason}"),
    }
}

/// Returns a number of cases, raised in proportion where `PROPTEST_CASES` asks for more than its default, 256.
fn cases(normal: u32) -> u32 {
    normal * Config::default().cases.div_ceil(256)
}

fn compile(frame: Frame<'_>) -> Result<Plan, Error> {
    frame.compile().map(|compiled| compiled.into_plan())
}

fn check(spec: &Spec, counts: &Counts) -> Result<(), TestCaseError> {
    let Some(plan) = check_frame(spec).map_err(TestCaseError::fail)? else {
        counts.add("refused frames", 1);
        return Ok(());
    };
    counts.frame(spec, &plan);
    // The text is long, and determined by the plan.
    if counts.count("frames").is_multiple_of(16) {
        let again = compile(spec.build().0).unwrap();
        prop_assert_eq!(plan.to_json().unwrap(), again.to_json().unwrap());
    }
    Ok(())
}

#[test]
fn every_rule_holds_on_random_frames_in_any_order_of_declaration() {
    let counts = Counts::default();
    let cases = cases(5_250);
    run(cases, 900, |bytes| {
        let spec = frame_from_bytes(bytes);
        check(&spec, &counts)?;
        let shuffled = shuffled(&spec, &mut Source::new(bytes));
        if shuffled != spec && check_frame(&shuffled).map_err(TestCaseError::fail)?.is_some() {
            counts.add("frames declared in another order", 1);
        }
        Ok(())
    });
    counts.print("random frames");
    counts.assert_rich(cases);
}

#[test]
fn an_error_in_a_random_frame_is_reported() {
    let made = Cell::new(0);
    run(cases(1_000), 600, |bytes| {
        let spec = small_frame_from_bytes(&bytes[1..], 12);
        let (code, report_error) = INVALID_CHANGES[usize::from(bytes[0]) % INVALID_CHANGES.len()];
        let (mut frame, _) = spec.build();
        report_error(&mut frame);
        made.set(made.get() + 1);
        let error = compile(frame).err();
        prop_assert_eq!(error.as_ref().map(Error::code), Some(code), "{:?}\n{}", error, spec);
        Ok(())
    });
    print(&format!("invalid frames: {} of {} kinds", made.get(), INVALID_CHANGES.len()));
}

#[test]
fn no_call_with_any_argument_panics() {
    let (valid, invalid) = (Cell::new(0), Cell::new(0));
    run(cases(4_000), 160, |bytes| {
        // Short ones are valid now and then.
        let length = 8 + usize::from(bytes[0]) % 100;
        let mut frame = random_calls_from_bytes(&bytes[1..length.min(bytes.len())]);
        // Checks after the first error must not panic either.
        let decl = frame.decl.clone();
        let _ignored = crate::compile::compile(decl);
        let count =
            if frame.check().and_then(|()| compile(frame).map(drop)).is_ok() { &valid } else { &invalid };
        count.set(count.get() + 1);
        Ok(())
    });
    print(&format!("frames of random calls: {} valid, {} refused", valid.get(), invalid.get()));
}

#[test]
fn a_resized_frame_and_one_with_other_clear_values_get_the_plan_of_a_full_compile() {
    let (resized, cleared, reused) = (Cell::new(0), Cell::new(0), Cell::new(0));
    let cases = cases(2_000);
    run(cases, 600, |bytes| {
        let spec = small_frame_from_bytes(bytes, 14);
        let larger = spec.scaled(2);
        let cleared_to_others = larger.with_other_clears();
        let mut graph = Graph::new();
        for spec in [&spec, &larger, &spec, &larger, &cleared_to_others, &larger] {
            let mut frame = graph.frame();
            spec.build_in(&mut frame);
            let planned = graph.compile(frame).map(|compiled| compiled.into_plan());
            prop_assert!(planned == compile(spec.build().0), "another plan\n{}", spec);
        }
        resized.set(resized.get() + graph.plan_counts().resized);
        cleared.set(cleared.get() + graph.plan_counts().cleared);
        reused.set(reused.get() + graph.plan_counts().reused);
        Ok(())
    });
    let (resized, cleared, reused) = (resized.get(), cleared.get(), reused.get());
    print(&format!("plans: {resized} resized, {cleared} with other clear values, {reused} reused"));
    assert!(resized.min(cleared) > u64::from(cases) / 10 && reused > u64::from(cases));
}
