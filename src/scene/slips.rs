//! Common slips in TOML: words without quotes, decimal commas, units after numbers.

/// Returns the likely slip in a line that is not TOML, with its correction, if the slip is a known one.
pub(super) fn slip(text: &str, place: usize) -> Option<String> {
    let start = text[..place.min(text.len())].rfind('\n').map_or(0, |end| end + 1);
    let line = text[start..].lines().next()?;
    if let Some(quote) = line.chars().find(|c| "“”„‘’«»".contains(*c)) {
        return Some(format!(
            "{quote} is a typographic quotation mark: words stand in straight ones, as in name = \"anchor\""
        ));
    }
    if line.trim_start().starts_with('[') && !line.contains(['=', ',']) {
        return None; // the header of a table
    }
    let tokens = tokens(line);
    let commas = tokens
        .iter()
        .position(is_behind_comma)
        .map(|at| comma(&tokens, at));
    commas
        .or_else(|| tokens.iter().find_map(odd))
        .or_else(|| unjoined(line, &tokens))
}

fn is_number(text: &str) -> bool {
    text.parse::<f64>().is_ok() && text.contains(|c: char| c.is_ascii_digit())
}

/// Returns whether a number follows a number and a comma, outside brackets.
fn is_behind_comma(token: &Token) -> bool {
    token.before == ','
        && !token.in_array
        && token.after != '='
        && is_number(token.last)
        && is_number(token.text)
}

/// Describes the slip in numbers separated by commas, the second of which is token `at`: a decimal comma, possibly after thousands separators, or a
/// list without brackets.
fn comma(tokens: &[Token], at: usize) -> String {
    let more = tokens[at..].iter().take_while(|token| is_behind_comma(token));
    let numbers: Vec<&str> = [tokens[at].last]
        .into_iter()
        .chain(more.map(|token| token.text))
        .collect();
    let (whole, given) = (numbers[0], numbers.join(","));
    let thousands = whole.split('.').skip(1).collect::<Vec<_>>();
    match numbers[..] {
        [_, decimals]
            if !decimals.contains('.')
                && !decimals.starts_with('-')
                && thousands.iter().all(|group| group.len() == 3) =>
        {
            let more = if thousands.is_empty() {
                ""
            } else {
                ", and nothing between thousands"
            };
            let whole = whole.replace('.', "");
            format!("`{given}` has a decimal comma: numbers have a point, {whole}.{decimals}{more}")
        }
        _ => format!(
            "several numbers stand in brackets, [{}], and a single one has no comma",
            numbers.join(", ")
        ),
    }
}

/// Text between two delimiters of a line, outside quotes.
struct Token<'t> {
    text: &'t str,
    /// The delimiters on both sides; a space at the ends of the line.
    before: char,
    after: char,
    /// The token before.
    last: &'t str,
    /// True if the innermost bracket is a square one.
    in_array: bool,
}

fn tokens(line: &str) -> Vec<Token<'_>> {
    let (mut found, mut open, mut quote) = (Vec::new(), Vec::new(), None);
    let (mut start, mut before, mut last) = (0, ' ', "");
    let ends = line.char_indices().chain([(line.len(), ' ')]);
    for (place, c) in ends {
        match (quote, c) {
            (Some(other), _) if place < line.len() => {
                if c == other {
                    quote = None;
                }
                continue;
            }
            (None, '"' | '\'') => {
                quote = Some(c);
                continue;
            }
            (_, '=' | ',' | '[' | ']' | '{' | '}' | '#') => {}
            _ if place == line.len() => {}
            _ => continue,
        }
        let text = line[start..place].trim();
        found.push(Token {
            text,
            before,
            after: c,
            last,
            in_array: open.last() == Some(&'['),
        });
        match c {
            '[' | '{' => open.push(c),
            ']' | '}' => drop(open.pop()),
            '#' => break,
            _ => {}
        }
        (start, before, last) = (place + c.len_utf8(), c, text);
    }
    found
}

/// Returns the slip in a value.
fn odd(token: &Token) -> Option<String> {
    let text = token.text;
    if token.before == '=' && text.is_empty() && !matches!(token.after, '[' | '{') {
        return Some(format!("no value stands after `{} =`", token.last));
    }
    let value = token.before == '=' || token.in_array && matches!(token.before, ',' | '[');
    if !value || token.after == '=' || text.is_empty() || text.starts_with(['"', '\'']) {
        return None;
    }
    let lower = text.to_lowercase();
    let truths = [(true, ["true", "yes", "on"]), (false, ["false", "no", "off"])];
    if let Some((truth, _)) = truths.iter().find(|(_, words)| words.contains(&lower.as_str())) {
        return (text != truth.to_string()).then(|| format!("`{text}` is written `{truth}`"));
    }
    if is_number(text) {
        return unfinished(text);
    }
    if lower.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
        return not_a_number(text, &lower);
    }
    let word = lower.starts_with(char::is_alphabetic)
        && !lower.contains(['"', '\'', '.'])
        && !["inf", "nan"].contains(&lower.as_str());
    word.then(|| format!("`{text}` is a word without quotes: write \"{text}\""))
}

/// Number without a digit before or after its point, as other languages allow.
fn unfinished(text: &str) -> Option<String> {
    let bare = text.trim_start_matches(['+', '-']);
    let sign = &text[..text.len() - bare.len()];
    let (whole, rest) = bare.split_once('.')?;
    let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    (whole.is_empty() || digits == 0).then(|| {
        let whole = if whole.is_empty() { "0" } else { whole };
        let zero = if digits == 0 { "0" } else { "" };
        format!("`{text}` lacks a digit next to its point: write {sign}{whole}.{zero}{rest}")
    })
}

fn not_a_number(text: &str, lower: &str) -> Option<String> {
    let exponent = lower.replacen('d', "e", 1);
    if exponent.parse::<f64>().is_ok() {
        return Some(format!("`{text}` has its exponent after a d: write {exponent}"));
    }
    let (number, rest) = text.split_once(char::is_whitespace)?;
    number.parse::<f64>().ok()?;
    Some(match rest.trim().parse::<f64>() {
        Ok(_) => format!("`{text}` lacks a comma between its numbers"),
        Err(_) if rest.contains('.') || rest.trim().contains(' ') => return None,
        Err(_) => format!(
            "`{text}` has a unit: numbers stand alone, and the page of the scene format names the unit of each"
        ),
    })
}

/// Line that lacks its `=`.
fn unjoined(line: &str, tokens: &[Token]) -> Option<String> {
    let first = tokens.first()?;
    if first.after == '=' || line.trim_start().starts_with('[') {
        return None;
    }
    let (key, value) = first.text.split_once([':', ' '])?;
    let is_key = !key.is_empty()
        && key
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c));
    (is_key && !value.trim().is_empty()).then(|| {
        format!(
            "no `=` between a key and its value: write {key} = {}",
            value.trim()
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::assert_answers;

    #[test]
    fn a_slip_is_called_by_what_it_looks_like() {
        assert_answers(
            "",
            include_str!("../../tests/scene/slips_of_syntax.txt"),
            |line| slip(&format!("title = \"a, b\"\n{line} # c\n"), 18).unwrap_or_default(),
        );
    }

    #[test]
    fn what_is_no_slip_is_left_to_the_parser() {
        for line in [
            "[[points]]",
            "position = [1, 2.5, -3e-4]",
            "water = { density = 1025.0, surface = true }",
            "title = 'a = fixed, 1,5'",
            "",
            "[line_types.chain]",
        ] {
            assert_eq!(slip(line, 0), None, "{line}");
        }
    }
}
