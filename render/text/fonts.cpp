#include "render/text/fonts.h"

#include <cairo/cairo.h>
#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <new>
#include <string>

#include "render/error.h"

namespace render {
namespace {

/// Pango has fontconfig load its lists in a thread of its own, which tries again for ever where memory does not suffice. Here it is
/// tried once.
void load_font_lists() {
  FcConfig* lists = FcInitLoadConfigAndFonts();
  if (!lists || !FcConfigSetCurrent(lists)) throw std::bad_alloc();
}

/// To look at letters without a picture. The layout keeps what it needs of the surface; g_object_unref ends it.
PangoLayout* layout_in_font() {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  cairo_t* cairo = cairo_create(surface);
  PangoLayout* layout = pango_cairo_create_layout(cairo);
  PangoFontDescription* font = pango_font_description_from_string(kFont);
  pango_layout_set_font_description(layout, font);
  pango_font_description_free(font);
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
  return layout;
}

bool letters_can_be_drawn() {
  load_font_lists();
  PangoLayout* layout = layout_in_font();
  pango_layout_set_text(layout, "Simulation 0123456789", -1);
  PangoRectangle ink;
  pango_layout_get_extents(layout, &ink, nullptr);
  const bool drawn = ink.width > 0 && pango_layout_get_unknown_glyphs_count(layout) == 0;
  g_object_unref(layout);
  return drawn;
}

}  // namespace

void require_font() {
  static const bool drawn = letters_can_be_drawn();
  if (!drawn) throw RenderError(std::string("drawing letters: the system has no font; install ") + kFont + " (fonts-dejavu-core)");
}

std::string without_glyph(const std::string& text) {
  if (std::all_of(text.begin(), text.end(), [](char byte) { return static_cast<unsigned char>(byte) < 0x80; })) return "";
  PangoLayout* layout = layout_in_font();
  // figures on paper take this font alone
  PangoAttrList* attributes = pango_attr_list_new();
  pango_attr_list_insert(attributes, pango_attr_fallback_new(FALSE));
  pango_layout_set_attributes(layout, attributes);
  pango_attr_list_unref(attributes);
  std::string out;
  const std::string valid = drawable(text);
  for (const char* at = valid.c_str(); *at; at = g_utf8_next_char(at)) {
    const std::string letter(at, static_cast<const char*>(g_utf8_next_char(at)));
    pango_layout_set_text(layout, letter.c_str(), -1);
    if (pango_layout_get_unknown_glyphs_count(layout) > 0 && out.find(letter) == std::string::npos) out += letter;
  }
  g_object_unref(layout);
  return out;
}

std::string drawable(const std::string& text) {
  char* valid = g_utf8_make_valid(text.data(), static_cast<gssize>(text.size()));
  const std::string out = valid;
  g_free(valid);
  return out;
}

}  // namespace render
