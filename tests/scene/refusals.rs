//! Every mistake once, in `refusals.txt`: a change of the small scene, and the line, column, key and problem reported.

use crate::common::assert_answers;
use crate::{SCENE, said};

#[test]
fn every_mistake_is_refused_with_line_column_key_and_what_would_be_right() {
    assert_answers(SCENE, include_str!("refusals.txt"), said);
}
