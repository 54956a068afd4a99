use super::*;

#[test]
fn the_help_of_every_setting_says_its_default() {
    for setting in command().get_arguments() {
        let default = defaults::of_setting(setting.get_id().as_str());
        let help = setting.get_help().map(ToString::to_string).unwrap_or_default();
        assert!(help.ends_with(&format!("[default: {default}]")), "{setting}: {help}");
    }
}
