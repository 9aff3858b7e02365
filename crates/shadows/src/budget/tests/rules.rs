//! Which rules are allowed.

use super::*;

fn refused(change: impl FnOnce(&mut BudgetRules)) -> Option<&'static str> {
    let mut rules = BudgetRules::default();
    change(&mut rules);
    match QualityController::new(rules) {
        Ok(_) => None,
        Err(Error::Setting { field, .. }) => Some(field),
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn the_defaults_are_allowed_and_begin_with_all_of_it() {
    assert_eq!(refused(|_| ()), None);
    assert_eq!(BudgetRules::default().levels[0], Quality::default());
}

#[test]
fn no_default_level_asks_for_more_than_the_one_before() {
    for pair in BudgetRules::default().levels.windows(2) {
        assert!(pair[1].map_scale >= pair[0].map_scale, "{pair:?}");
        assert!(pair[1].cascades <= pair[0].cascades, "{pair:?}");
        assert!(pair[1].distance_scale < pair[0].distance_scale, "{pair:?}");
    }
}

#[test]
fn values_out_of_range_are_refused_by_name() {
    for budget in [0.0, 0.0009, 1000.1, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(|rules| rules.budget_ms = budget), Some("budget_ms"), "{budget}");
    }
    for scale in [0, 3, 16] {
        assert_eq!(refused(|rules| rules.levels[7].map_scale = scale), Some("levels.map_scale"), "{scale}");
    }
    for count in [0, 9] {
        assert_eq!(refused(|rules| rules.levels[7].cascades = count), Some("levels.cascades"), "{count}");
    }
    for scale in [0.0, 0.049, 1.01, f32::NAN] {
        let field = refused(|rules| rules.levels[7].distance_scale = scale);
        assert_eq!(field, Some("levels.distance_scale"), "{scale}");
    }
}

#[test]
fn the_ends_of_ranges_are_allowed() {
    for budget in [0.001, 1000.0] {
        assert_eq!(refused(|rules| rules.budget_ms = budget), None);
    }
    let cheapest = Quality { map_scale: 8, cascades: 1, distance_scale: 0.05 };
    assert_eq!(refused(|rules| rules.levels = vec![Quality::default(), cheapest]), None);
    assert_eq!(refused(|rules| rules.levels = vec![cheapest]), None);
}

#[test]
fn there_are_one_to_32_levels() {
    let level = |i: u8| Quality { distance_scale: 1.0 - f32::from(i) / 50.0, ..Quality::default() };
    let with = |count: u8| refused(|rules| rules.levels = (0..count).map(level).collect());
    assert_eq!([0, 1, 32, 33].map(with), [Some("levels"), None, None, Some("levels")]);
}

#[test]
fn levels_in_the_wrong_order_are_refused() {
    assert_eq!(refused(|rules| rules.levels.reverse()), Some("levels"));
    assert_eq!(refused(|rules| rules.levels[1] = Quality::default()), Some("levels"));
    let mut rules = BudgetRules::default();
    rules.levels.swap(2, 3);
    let message = rules.validate().unwrap_err().to_string();
    assert!(message.contains("nowhere cheaper in level 3 than in the one before"), "{message}");
}

#[test]
fn a_level_may_give_back_one_thing_for_another() {
    let sharp = Quality { map_scale: 1, cascades: 1, distance_scale: 0.2 };
    let far = Quality { map_scale: 4, cascades: 2, distance_scale: 1.0 };
    assert_eq!(refused(|rules| rules.levels = vec![Quality::default(), sharp, far]), None);
}

#[test]
fn rules_survive_a_file_and_unknown_fields_do_not() {
    let rules = BudgetRules { budget_ms: 1.25, ..BudgetRules::default() };
    let text = ron::to_string(&rules).unwrap();
    assert_eq!(ron::from_str::<BudgetRules>(&text).unwrap(), rules);
    assert!(ron::from_str::<BudgetRules>("(budget: 1.0)").is_err());
    assert!(ron::from_str::<BudgetRules>("(levels: [(map_size: 2)])").is_err());
}
