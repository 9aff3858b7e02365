//! Valid and invalid configurations.

use super::*;

fn rejected_field(change: impl FnOnce(&mut BudgetConfig)) -> Option<&'static str> {
    let mut config = BudgetConfig::default();
    change(&mut config);
    match QualityController::new(config) {
        Ok(_) => None,
        Err(Error::Setting { field, .. }) => Some(field.leak()),
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn the_defaults_are_valid_and_begin_with_the_full_quality() {
    assert_eq!(rejected_field(|_| ()), None);
    assert_eq!(BudgetConfig::default().levels[0], QualityLevel::default());
}

#[test]
fn no_default_level_costs_more_than_the_one_before() {
    for pair in BudgetConfig::default().levels.windows(2) {
        assert!(pair[1].map_scale >= pair[0].map_scale, "{pair:?}");
        assert!(pair[1].cascades <= pair[0].cascades, "{pair:?}");
        assert!(pair[1].distance_scale < pair[0].distance_scale, "{pair:?}");
    }
}

#[test]
fn values_out_of_range_are_rejected_by_name() {
    for budget in [0.0, 0.0009, 1000.1, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(rejected_field(|config| config.budget_ms = budget), Some("budget_ms"), "{budget}");
    }
    for scale in [0, 3, 16] {
        assert_eq!(
            rejected_field(|config| config.levels[7].map_scale = scale),
            Some("levels.7.map_scale"),
            "{scale}"
        );
    }
    for count in [0, 9] {
        assert_eq!(
            rejected_field(|config| config.levels[7].cascades = count),
            Some("levels.7.cascades"),
            "{count}"
        );
    }
    for scale in [0.0, 0.049, 1.01, f32::NAN] {
        let field = rejected_field(|config| config.levels[7].distance_scale = scale);
        assert_eq!(field, Some("levels.7.distance_scale"), "{scale}");
    }
}

#[test]
fn the_ends_of_ranges_are_valid() {
    for budget in [0.001, 1000.0] {
        assert_eq!(rejected_field(|config| config.budget_ms = budget), None);
    }
    let cheapest = QualityLevel { map_scale: 8, cascades: 1, distance_scale: 0.05 };
    assert_eq!(rejected_field(|config| config.levels = vec![QualityLevel::default(), cheapest]), None);
    assert_eq!(rejected_field(|config| config.levels = vec![cheapest]), None);
}

#[test]
fn there_are_one_to_32_levels() {
    let level = |i: u8| QualityLevel { distance_scale: 1.0 - f32::from(i) / 50.0, ..QualityLevel::default() };
    let with = |count: u8| rejected_field(|config| config.levels = (0..count).map(level).collect());
    assert_eq!([0, 1, 32, 33].map(with), [Some("levels"), None, None, Some("levels")]);
}

#[test]
fn levels_in_the_wrong_order_are_rejected() {
    assert_eq!(rejected_field(|config| config.levels.reverse()), Some("levels"));
    assert_eq!(rejected_field(|config| config.levels[1] = QualityLevel::default()), Some("levels"));
    let mut config = BudgetConfig::default();
    config.levels.swap(2, 3);
    let message = config.validate().unwrap_err().to_string();
    assert!(message.contains("level 3 is not cheaper than the one before"), "{message}");
}

#[test]
fn a_level_may_trade_one_value_for_another() {
    let sharp = QualityLevel { map_scale: 1, cascades: 1, distance_scale: 0.2 };
    let far = QualityLevel { map_scale: 4, cascades: 2, distance_scale: 1.0 };
    assert_eq!(rejected_field(|config| config.levels = vec![QualityLevel::default(), sharp, far]), None);
}

#[test]
fn a_config_survives_a_file_and_unknown_fields_are_rejected() {
    let config = BudgetConfig { budget_ms: 1.25, ..BudgetConfig::default() };
    let text = ron::to_string(&config).unwrap();
    assert_eq!(ron::from_str::<BudgetConfig>(&text).unwrap(), config);
    assert!(ron::from_str::<BudgetConfig>("(budget: 1.0)").is_err());
    assert!(ron::from_str::<BudgetConfig>("(levels: [(map_size: 2)])").is_err());
}
