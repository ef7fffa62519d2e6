//! Numbers as people write and read them.

use std::time::Duration;

/// Reads a count: `5000`, `1_000_000`, `1e6`, `200k`, `2.5M`, `1G`.
///
/// # Errors
/// A sentence, if `text` is not a whole number from 1 that can be counted exactly (up to 2^53).
pub fn parse_count(text: &str) -> Result<u64, String> {
    let (digits, unit) = match text.char_indices().next_back() {
        Some((end, 'k' | 'K')) => (&text[..end], 1e3),
        Some((end, 'M')) => (&text[..end], 1e6),
        Some((end, 'G')) => (&text[..end], 1e9),
        _ => (text, 1.0),
    };
    let number = digits.replace('_', "").parse::<f64>().map(|n| n * unit).unwrap_or(f64::NAN);
    if (1.0..=9_007_199_254_740_992.0).contains(&number) && number.fract() == 0.0 {
        return Ok(number as u64);
    }
    Err("give a whole number from 1, like 50000, 1e6, 200k or 2.5M".to_owned())
}

/// Reads a time: `90`, `90s`, `2min`, `1.5h`.
///
/// # Errors
/// A sentence, if `text` is not a positive time of less than a year.
pub fn parse_time(text: &str) -> Result<Duration, String> {
    let end = text.find(|c: char| c.is_alphabetic()).unwrap_or(text.len());
    let unit = match text[end..].trim() {
        "" | "s" | "sec" => 1.0,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => f64::NAN,
    };
    let seconds = text[..end].trim().parse::<f64>().map(|n| n * unit).unwrap_or(f64::NAN);
    if seconds > 0.0 && seconds < 3.2e7 {
        return Ok(Duration::from_secs_f64(seconds));
    }
    Err("give a time like 90, 90s, 2min or 1.5h".to_owned())
}

/// Reads a share: `2%`, `0.5 %`, `0.02`.
///
/// # Errors
/// A sentence, if `text` is not between 0 and 1, without these.
pub fn parse_share(text: &str) -> Result<f64, String> {
    let (digits, unit) = match text.strip_suffix('%') {
        Some(percents) => (percents, 100.0),
        None => (text, 1.0),
    };
    let share = digits.trim().parse::<f64>().map(|n| n / unit).unwrap_or(f64::NAN);
    if share > 0.0 && share < 1.0 { Ok(share) } else { Err("give a share like 2%, 0.5% or 0.02".to_owned()) }
}

/// A count with separators: `1,234,567`.
pub fn count(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A large number in words: `950`, `12.3 thousand`, `4.56 million`.
pub fn in_words(number: f64) -> String {
    match number {
        n if n < 1e4 => format!("{n:.0}"),
        n if n < 1e6 => format!("{} thousand", three_digits(n / 1e3)),
        n if n < 1e9 => format!("{} million", three_digits(n / 1e6)),
        n => format!("{} billion", three_digits(n / 1e9)),
    }
}

/// A large number with a prefix: `950`, `12.3k`, `4.56M`.
pub fn with_prefix(number: f64) -> String {
    match number {
        n if n < 1e3 => format!("{n:.0}"),
        n if n < 1e6 => format!("{}k", three_digits(n / 1e3)),
        n if n < 1e9 => format!("{}M", three_digits(n / 1e6)),
        n => format!("{}G", three_digits(n / 1e9)),
    }
}

/// Three significant digits; all digits before the point.
pub fn three_digits(number: f64) -> String {
    digits(number, 3)
}

/// `significant` digits; all digits before the point.
pub fn digits(number: f64, significant: i32) -> String {
    let decimals = decimals_for(number, significant);
    format!("{number:.decimals$}")
}

/// Decimals with which `number` shows `significant` digits, at most 9.
pub fn decimals_for(number: f64, significant: i32) -> usize {
    if number == 0.0 || !number.is_finite() {
        return 0;
    }
    (significant - 1 - number.abs().log10().floor() as i32).clamp(0, 9) as usize
}

/// A share with three digits: `12.3 %`, `0.0450 %`, `< 0.01 %`, `0 %`.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".to_owned(),
        percents if percents.abs() < 0.01 => "< 0.01 %".to_owned(),
        percents => format!("{} %", three_digits(percents)),
    }
}

/// A time: `0.42 s`, `12.3 s`, `2 min 05 s`, `1 h 02 min`.
pub fn time(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match seconds {
        s if s < 10.0 => format!("{s:.2} s"),
        s if s < 99.5 => format!("{s:.1} s"),
        s if s < 3600.0 => format!("{} min {:02} s", whole / 60, whole % 60),
        _ => format!("{} h {:02} min", whole / 3600, whole % 3600 / 60),
    }
}

/// A number of bytes: `512 B`, `3.4 kB`, `12.3 MB`.
pub fn bytes(number: usize) -> String {
    match number as f64 {
        n if n < 1e3 => format!("{n:.0} B"),
        n if n < 1e6 => format!("{} kB", three_digits(n / 1e3)),
        n if n < 1e9 => format!("{} MB", three_digits(n / 1e6)),
        n => format!("{} GB", three_digits(n / 1e9)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_read_as_people_write_them() {
        let known = [("1", 1), ("1e6", 1_000_000), ("200k", 200_000), ("2.5M", 2_500_000), ("1_000", 1000)];
        for (text, number) in known {
            assert_eq!(parse_count(text), Ok(number), "{text}");
        }
        for text in ["", "0", "-1", "1.5", "k", "nan", "inf", "1e300", "12x", "1µ"] {
            assert!(parse_count(text).is_err(), "{text}");
        }
    }

    #[test]
    fn times_are_read_as_people_write_them() {
        for (text, seconds) in [("90", 90.0), ("90s", 90.0), ("2min", 120.0), ("1.5 h", 5400.0), ("0.5", 0.5)] {
            assert_eq!(parse_time(text), Ok(Duration::from_secs_f64(seconds)), "{text}");
        }
        for text in ["", "0", "-1s", "s", "2 weeks", "inf", "1e9"] {
            assert!(parse_time(text).is_err(), "{text}");
        }
    }

    #[test]
    fn shares_are_read_as_people_write_them() {
        for (text, share) in [("2%", 0.02), ("0.5 %", 0.005), ("0.02", 0.02), ("95%", 0.95), ("1e-3", 0.001)] {
            assert_eq!(parse_share(text), Ok(share), "{text}");
        }
        for text in ["", "%", "0", "-1%", "2", "100%", "nan", "2 percent"] {
            assert!(parse_share(text).is_err(), "{text}");
        }
    }

    #[test]
    fn numbers_are_written_as_people_read_them() {
        assert_eq!([count(7), count(1234), count(1_234_567)], ["7", "1,234", "1,234,567"]);
        assert_eq!([in_words(950.0), in_words(12_345.0), in_words(4.56e6)], ["950", "12.3 thousand", "4.56 million"]);
        assert_eq!(
            [percent(0.1234), percent(4.5e-4), percent(4e-5), percent(0.0)],
            ["12.3 %", "0.0450 %", "< 0.01 %", "0 %"]
        );
        assert_eq!(
            [time(0.42), time(12.34), time(125.0), time(3720.0)],
            ["0.42 s", "12.3 s", "2 min 05 s", "1 h 02 min"]
        );
        assert_eq!([bytes(512), bytes(3400), bytes(12_300_000)], ["512 B", "3.40 kB", "12.3 MB"]);
    }
}
