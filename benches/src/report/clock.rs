//! The date of a measurement.

use std::time::SystemTime;

/// Today, `YYYY-MM-DD`, UTC.
pub(super) fn today() -> String {
    let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    now.split('T').next().unwrap_or_default().to_owned()
}
