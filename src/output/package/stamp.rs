//! Author and date of an FMU, which do not belong to its scene.

/// Author and date in the description of an FMU; the instantiation token does not depend on them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Stamp {
    /// Author of the model; left out where absent.
    pub author: Option<String>,
    /// Time of generation, as `2026-11-25T23:45:00Z`; left out where absent, so that the same scene gives the same bytes.
    pub date: Option<String>,
}

/// Seconds of a day [s].
const DAY: u64 = 86_400;
/// Days of 400 years [-].
const ERA: u64 = 146_097;
/// Days from 1 March of year 0 to 1 January 1970 [-].
const EPOCH: u64 = 719_468;

/// Date and time in UTC of a time since 1970 [s].
///
/// Civil date of a day number in the proleptic Gregorian calendar. Years begin in March, so that the leap day is the last of a year: of
/// the days of a year, month m (0 is March) begins at (153 m + 2)/5. Valid for all years after 1970.
pub fn date(seconds: u64) -> String {
    let days = seconds / DAY + EPOCH;
    let (era, day_of_era) = (days / ERA, days % ERA);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 {
        from_march + 3
    } else {
        from_march - 9
    };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    let clock = seconds % DAY;
    let (hour, minute, second) = (clock / 3600, clock / 60 % 60, clock % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_follow_the_calendar_over_leap_days_and_centuries() {
        for (seconds, text) in [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (1_709_251_199, "2024-02-29T23:59:59Z"),
            (1_767_225_600, "2026-01-01T00:00:00Z"),
            (4_107_542_400, "2100-03-01T00:00:00Z"),
        ] {
            assert_eq!(date(seconds), text);
        }
    }
}
