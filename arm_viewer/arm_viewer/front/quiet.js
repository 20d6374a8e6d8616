/* Hide viser's warning about software rendering, which covers the robot. This page is made for it. */
(() => {
  "use strict";
  const WARNING = "Software WebGL";
  new MutationObserver((changes, observer) => {
    for (const shown of document.querySelectorAll(".mantine-Notification-root")) {
      if (!shown.textContent.includes(WARNING)) continue;
      shown.style.display = "none";
      observer.disconnect();
    }
  }).observe(document, { childList: true, subtree: true });
})();
