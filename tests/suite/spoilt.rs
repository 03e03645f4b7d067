//! Nothing that is read panics: a few hundred spoilt texts. The long run is
//! `tests/fuzz/spoil.rs`.

#[path = "../fuzz/spoiling.rs"]
mod spoiling;

use proptest::prelude::{ProptestConfig, any, proptest};
use spoiling::Valid;
use std::sync::LazyLock;

static VALID: LazyLock<Valid> = LazyLock::new(Valid::new);

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// A spoilt text is read, or refused, with a reason.
    #[test]
    fn a_spoilt_text_is_made_or_refused_in_words(seed in any::<u64>()) {
        VALID.run(&VALID.spoilt(seed));
    }
}
