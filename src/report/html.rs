//! Writing HTML: everything that comes from a file is escaped, and only here.

use std::fmt::Write;

/// HTML under construction.
#[derive(Debug, Default)]
pub(super) struct Html(String);

impl Html {
    /// Markup that this program wrote itself.
    pub(super) fn markup(&mut self, markup: &str) {
        self.0.push_str(markup);
    }

    /// An element around a text.
    pub(super) fn text(&mut self, element: &str, text: &str) {
        // Writing to a String does not fail.
        let _ = writeln!(self.0, "<{element}>{}</{element}>", escaped(text));
    }

    /// A list of texts; nothing where there is none.
    pub(super) fn list(&mut self, items: &[String]) {
        if items.is_empty() {
            return;
        }
        self.markup("<ul>\n");
        for item in items {
            self.text("li", item);
        }
        self.markup("</ul>\n");
    }

    /// A table of texts; nothing where there is no row.
    pub(super) fn table(&mut self, header: &[&str], rows: &[Vec<String>]) {
        if rows.is_empty() {
            return;
        }
        self.markup("<div class=\"wide\"><table>\n<thead><tr>");
        for cell in header {
            self.text("th", cell);
        }
        self.markup("</tr></thead>\n<tbody>\n");
        for row in rows {
            self.markup("<tr>");
            for cell in row {
                self.text("td", cell);
            }
            self.markup("</tr>\n");
        }
        self.markup("</tbody></table></div>\n");
    }

    /// Names and texts; what has no text is left out.
    pub(super) fn facts(&mut self, facts: &[(&str, Option<String>)]) {
        let known: Vec<Vec<String>> = facts
            .iter()
            .filter_map(|(name, text)| text.as_ref().map(|text| vec![(*name).to_owned(), text.clone()]))
            .collect();
        if known.is_empty() {
            return;
        }
        self.markup("<div class=\"wide\"><table class=\"facts\"><tbody>\n");
        for fact in known {
            self.markup("<tr>");
            self.text("th", &fact[0]);
            self.text("td", &fact[1]);
            self.markup("</tr>\n");
        }
        self.markup("</tbody></table></div>\n");
    }

    pub(super) fn finish(self) -> String {
        self.0
    }
}

/// Text as HTML; control characters, which HTML does not allow, become spaces.
pub(super) fn escaped(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => html.push_str("&amp;"),
            '<' => html.push_str("&lt;"),
            '>' => html.push_str("&gt;"),
            '"' => html.push_str("&quot;"),
            '\'' => html.push_str("&#39;"),
            '\n' | '\t' => html.push(c),
            c if c.is_control() => html.push(' '),
            c => html.push(c),
        }
    }
    html
}

/// A number to six significant digits without needless zeros; `unknown` where it is not finite.
pub(super) fn number(value: f64) -> String {
    if !value.is_finite() {
        return "unknown".to_owned();
    }
    let text = significant(value, 6);
    let is_plain = text.contains('.') && !text.contains('\u{b7}');
    if is_plain { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A value to the digit to which its standard uncertainty (two digits) is known.
pub(super) fn value_and_uncertainty(value: f64, sigma: f64) -> (String, String) {
    let usable = value.is_finite() && sigma.is_finite() && sigma > 0.0;
    if !usable {
        let known = if sigma.is_finite() { number(sigma) } else { "unknown".to_owned() };
        return (number(value), known);
    }
    let last_digit = sigma.log10().floor() as i32 - 1;
    let digits = if value == 0.0 { 2 } else { value.abs().log10().floor() as i32 - last_digit + 1 };
    (significant(value, digits.clamp(1, 12) as usize), significant(sigma, 2))
}

/// A number to some significant digits, without an exponent where it is of ordinary size.
pub(super) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let magnitude = value.abs().log10().floor();
    if !(-4.0..6.0).contains(&magnitude) {
        return super::ticks::power_of_ten(&format!("{value:.*e}", digits.saturating_sub(1)));
    }
    let decimals = (digits as f64 - 1.0 - magnitude).max(0.0) as usize;
    format!("{value:.decimals$}").replacen('-', "\u{2212}", 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_from_a_file_becomes_markup() {
        assert_eq!(escaped("<a href='x'>\"&\u{1}"), "&lt;a href=&#39;x&#39;&gt;&quot;&amp; ");
    }

    #[test]
    fn a_value_is_given_to_the_digit_that_is_known() {
        assert_eq!(value_and_uncertainty(1.015_113, 0.000_412), ("1.01511".to_owned(), "0.00041".to_owned()));
        assert_eq!(value_and_uncertainty(30.123, 2.5), ("30.1".to_owned(), "2.5".to_owned()));
        assert_eq!(value_and_uncertainty(0.5, f64::NAN), ("0.5".to_owned(), "unknown".to_owned()));
        assert_eq!(number(f64::NAN), "unknown");
        assert_eq!(number(1.5e-9), "1.50000·10⁻⁹");
    }
}
