/* `armMake(tag, fields, ...children)` makes an element with these properties, or attributes where it
has no such property. */
window.armMake = (tag, fields = {}, ...children) => {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(fields)) {
    if (name in element) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
};
