// Functions of std::filesystem::path that libc++ 19 declares and, without files, does not define. Paths are POSIX's:
// names between slashes.

#include <filesystem>
#include <string>
#include <vector>

namespace std { inline namespace _LIBCPP_ABI_NAMESPACE { namespace filesystem {
namespace {

/// The place after the root directory.
size_t root_end(string_view path) {
  const size_t end = path.find_first_not_of('/');
  return path.empty() || path[0] != '/' ? 0 : end == string_view::npos ? path.size() : end;
}

/// The elements that iterators visit: the root directory, the names, and an empty one after a slash at the end.
vector<string_view> elements(string_view path) {
  vector<string_view> list;
  size_t at = root_end(path);
  if (at > 0) list.push_back(path.substr(0, 1));
  while (at < path.size()) {
    const size_t end = min(path.find('/', at), path.size());
    list.push_back(path.substr(at, end - at));
    at = min(path.find_first_not_of('/', end), path.size());
    if (at == path.size() && end < at) list.push_back(path.substr(at, 0));
  }
  return list;
}

/// Where the extension of a name begins: at its end if it has none.
size_t extension_begin(string_view name) {
  const size_t dot = name.rfind('.');
  return dot == string_view::npos || dot == 0 || name == ".." ? name.size() : dot;
}

}  // namespace

path::__string_view path::__root_name() const { return {}; }
path::__string_view path::__root_directory() const { return __string_view(__pn_).substr(0, root_end(__pn_) > 0); }
path::__string_view path::__root_path_raw() const { return __root_directory(); }
path::__string_view path::__relative_path() const { return __string_view(__pn_).substr(root_end(__pn_)); }

path::__string_view path::__parent_path() const {
  const __string_view all = __pn_;
  const size_t root = root_end(all);
  size_t end = all.rfind('/');
  if (end == __string_view::npos) return {};
  if (end < root) return all.substr(0, root == all.size() ? all.size() : 1);
  while (end > root && all[end - 1] == '/') --end;
  return all.substr(0, end);
}

path::__string_view path::__filename() const {
  const __string_view rest = __relative_path();
  return rest.substr(rest.rfind('/') + 1);  // 0 if there is no slash
}

path::__string_view path::__stem() const { return __filename().substr(0, extension_begin(__filename())); }
path::__string_view path::__extension() const { return __filename().substr(extension_begin(__filename())); }

int path::__compare(__string_view other) const {
  if ((root_end(__pn_) > 0) != (root_end(other) > 0)) return root_end(__pn_) > 0 ? 1 : -1;
  const vector<string_view> own = elements(__pn_), others = elements(other);
  for (size_t k = 0; k < min(own.size(), others.size()); ++k)
    if (const int order = own[k].compare(others[k]); order != 0) return order;
  return own.size() == others.size() ? 0 : own.size() < others.size() ? -1 : 1;
}

path path::lexically_normal() const {
  if (__pn_.empty()) return *this;
  vector<string_view> kept;
  const bool is_absolute = root_end(__pn_) > 0;
  bool ends_in_slash = false;
  for (const string_view name : elements(__relative_path())) {
    const bool is_up = name == "..", is_lead = kept.empty() || kept.back() == "..";
    ends_in_slash = is_up ? !is_lead : name == "." || name.empty();
    if (is_up && !is_lead)
      kept.pop_back();
    else if (!name.empty() && name != "." && !(is_up && is_absolute))
      kept.push_back(name);
  }
  std::string text = is_absolute ? "/" : "";
  for (size_t k = 0; k < kept.size(); ++k) text.append(k > 0 ? "/" : "").append(kept[k]);
  if (text.empty()) return ".";
  if (ends_in_slash && !kept.empty() && kept.back() != "..") text += '/';
  return text;
}

path::iterator path::begin() const {
  const vector<string_view> list = elements(__pn_);
  iterator first = end();
  if (list.empty()) return first;
  first.__state_ = iterator::_InFilenames;
  first.__entry_ = list.front();
  first.__stashed_elem_ = std::string(list.front());
  return first;
}

path::iterator path::end() const {
  iterator last;
  last.__path_ptr_ = this;
  last.__state_ = iterator::_AtEnd;
  // Beyond an empty last element, which lies at the end of the text.
  last.__entry_ = __string_view(__pn_.data() + __pn_.size() + 1, 0);
  if (__pn_.empty()) last.__entry_ = __string_view(__pn_);
  return last;
}

path::iterator& path::iterator::__increment() {
  const vector<string_view> list = elements(__path_ptr_->native());
  for (size_t k = 0; k < list.size(); ++k) {
    if (list[k].data() != __entry_.data()) continue;
    if (k + 1 == list.size()) return *this = __path_ptr_->end();
    __entry_ = list[k + 1];
    __stashed_elem_ = std::string(__entry_);
    return *this;
  }
  return *this = __path_ptr_->end();
}

}}}  // namespace std::_LIBCPP_ABI_NAMESPACE::filesystem
